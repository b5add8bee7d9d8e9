/// The nodal scheme: total formulation, particles for ever on the reference lattice, velocity and displacement for ever
/// on the nodes.
///
/// With weights that never change there is no need to carry velocity to the particles and back: the nodes keep it,
///   v_i += dt (f_i / m_i + g),  u_i += dt v_i,  F_p = I + sum_i u_i (x) grad w_ip,
/// m_i is mapped once, and a step moves nothing but forces. It is FLIP without the smoothing of its two mappings, and
/// explicit finite elements with lumped mass and eight points per cell. Eight particles per cell at 1/4 and 3/4 of each
/// edge share the same weights in every cell, so lanes are cells (transfer/cell_block.h).
///
/// Between outputs stress and plastic strain live here, motion on the nodes, and the particles' columns for them are
/// empty; decohesion state stays with the particles.
#pragma once

#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/cell_block.h"
#include "transfer/onset.h"
#include "transfer/passes.h"

#include <cstdint>
#include <variant>
#include <vector>

namespace transfer
{
/// Blocks of all leaves with the state of their particles.
template <class T>
struct BlockTable
{
    std::vector<std::uint32_t> start; // [leaf + 1] blocks of a leaf
    std::vector<CellBlock<T>> block;
    std::vector<BlockState<T>> state; // [block]
};

struct Lattice
{
    static constexpr int mixed = -1;

    std::vector<std::uint8_t> cracked;     // [leaf][512] 1: some particle of the cell has decohesion state
    std::vector<std::int32_t> material;    // [leaf] index of the only material, or `mixed`
    std::vector<std::vector<Onset>> onset; // [leaf] scratch of a step
    std::vector<std::vector<int>> near;    // [leaf] cells the step did not clear of onset; kept for nonlocal laws only
    std::variant<BlockTable<Real>, BlockTable<float>> blocks; // float: precision `mixed`

    bool in_use() const { return !material.empty(); }
};

/// Put the particles on the lattice: stress, plastic strain and volume go to the blocks, the columns that lattice and
/// nodes hold from now on are emptied.
/// @return false, nothing changed, if some particle is on no slot or two share one (two bodies in one sub-cell, other
///         particle counts)
bool enter_lattice(Precision precision, const grid::Levels& levels, particles::Particles& particles, Lattice& lattice);

/// From the nodal velocity: strain, stress, decohesion state, and the internal force f_i = - sum V0 P grad_X w of the
/// next step. Onsets take effect in the next step.
///
/// @param levels     reads motion (halos filled); writes force (halos not yet assembled)
/// @param lattice    stress, plastic strain
/// @param particles  crack, cracks
/// @param leaf_work  adds the step's dissipation per leaf
void advance_lattice(const PassOptions& options, const LawTable& laws, Lattice& lattice,
                     particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work);

/// The same for the levels of `steps`, each over its own dt, which ends now (options.time).
void advance_lattice(const grid::LevelSteps& steps, const PassOptions& options, const LawTable& laws, Lattice& lattice,
                     particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work);

/// What the particles of one leaf say together.
struct LatticeSurvey
{
    Real elastic = 0; // mJ
    Real squeeze = 0; // 1, of the cell that shortens the step most (lattice_squeeze.h); not finite if some F is not
    std::size_t worst = 0; // its particle that does
};

/// Survey of every leaf; reads motion (halos filled).
void survey_lattice(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                    const grid::Levels& levels, std::vector<LatticeSurvey>& survey);

/// Displacement of one particle [mm].
Vec3 displacement_of(const particles::Particles& particles, const grid::Levels& levels, std::size_t particle);

/// Fill position, velocity, deformation gradient, stress and plastic strain of all particles, for output; allocates.
void fill_columns(const grid::Levels& levels, const Lattice& lattice, particles::Particles& particles);

/// Empty them again.
void drop_columns(particles::Particles& particles);
} // namespace transfer
