/// The passes over particles, each one loop over leaves; the grid work between them is in grid/.
///
/// A step reads (stress update last):   grid phases -> advance_and_scatter
/// and with a second mapping (MUSL):    grid phases -> remap_momentum -> grid phases -> advance_and_scatter
///
/// Each leaf is one task and adds in storage order, so results do not depend on the number of threads. The sums a step
/// starts from are always those of the particles' present state: `scatter` after (re)ordering, `advance_and_scatter`
/// otherwise, in the same order and with the same arithmetic, so that a restart finds the same bits.
#pragma once

#include "grid/levels.h"
#include "grid/walls.h"
#include "particles/particles.h"
#include "transfer/law_table.h"
#include "transfer/scheme.h"
#include "transfer/strays.h"

#include <vector>

namespace transfer
{
struct PassOptions
{
    Formulation formulation = Formulation::total;
    Transfer transfer = Transfer::flip;
    StressUpdate stress_update = StressUpdate::usl;
    Precision precision = Precision::f64;
    Real pic_fraction = 0; // 1
    Real dt = 0;           // ms
    Real time = 0;         // ms, at the end of the step
    Basis basis = Basis::trilinear;
    int per_axis = 2;                   // particles per cell and axis: the size of the boxes of gimp
    std::vector<grid::WallPlane> walls; // symmetry planes: balls and the boxes of gimp are reflected there
};

/// Do the passes use boxes? In the total formulation boxes lie on the lattice and never leave their cells: the mean
/// over a box is the value in its centre, and gimp is trilinear.
inline bool uses_boxes(const PassOptions& options)
{
    return options.basis == Basis::gimp && options.formulation == Formulation::updated;
}

/// Dissipation of one leaf so far [mJ].
struct LeafWork
{
    Real plastic = 0;
    Real decohesion = 0;
};

/// Mass, momentum and internal force of every particle to the nodes of its own leaf's tile (P2G).
///
/// m_i = sum w m,   p_i = sum w m (v [+ C (x_i - x)]),   f_i = - sum V sigma grad w   (total: - sum V0 P grad_X w)
///
/// @param strays  reads the particles outside their home cell; gimp: writes the cut boxes, who gets them, and `outside`
/// @param levels  reads leaves, cell_start; writes sum (halos not yet assembled, interfaces not yet restricted)
void scatter(const PassOptions& options, const LawTable& laws, Strays& strays, const particles::Particles& particles,
             grid::Levels& levels);

/// Move particles with the updated nodal velocity, update stress and decohesion state, scatter for the next step.
///
/// FLIP: v += sum w (v+ - v) blended with PIC; APIC: v = sum w v+, C = sum v+ (x) grad w; x += dt sum w v+.
/// Strain from grad v+ (USL) or from the velocity mapped again (MUSL: `change` of the motion tiles holds it, and the
/// particle velocity has been updated by remap_momentum).
///
/// @param strays     reads the particles outside their home cell; writes those of the new positions
/// @param levels     reads motion (halos filled); writes sum
/// @param leaf_work  adds the step's dissipation per leaf
void advance_and_scatter(const PassOptions& options, const LawTable& laws, Strays& strays,
                         particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work);

/// MUSL: update particle velocities and map their momentum again, with the weights of the step's beginning.
/// @param levels  reads motion; writes the momentum of sum (mass stays)
void remap_momentum(const PassOptions& options, Strays& strays, particles::Particles& particles, grid::Levels& levels);
} // namespace transfer
