/// The nodal scheme below the solver: a scene whose particles are on the lattice, and its steps.
#pragma once

#include "grid/fast_nodes.h"
#include "tests/support/dense_nodal.h"
#include "tests/support/scene.h"
#include "transfer/lattice.h"

namespace support
{
struct LatticeRun
{
    Scene scene;
    transfer::Lattice lattice;
    std::vector<grid::WallPlane> walls;
    Vec3 gravity = Vec3::Zero(); // mm/ms^2
    Real plastic_work = 0;       // mJ, of all steps
    Real decohesion_work = 0;    // mJ, likewise
    grid::FastNodes fast_nodes;  // sub-cycling only
};

/// Particles on the lattice of a topology as a cut body has them: one in five is missing, and one cell in ten is empty;
/// volumes differ. Below x = 0 they are of the first material, above of any.
Scene cut_scene(const Topology& topology, const std::vector<material::Material>& materials, std::uint64_t seed);

/// Random stress of some MPa and random velocity of some mm/ms for every particle.
void stir(std::uint64_t seed, Real stress, Real velocity, Scene& scene);

/// Motion to the nodes, particles to the lattice.
LatticeRun lattice_run(Scene scene, transfer::Precision precision, const std::vector<grid::WallPlane>& walls = {},
                       const Vec3& gravity = Vec3::Zero());

void advance(Real dt, LatticeRun& run);

/// Sub-cycled step of the coarsest level; dt is that of the finest.
void advance_subcycled(Real dt, LatticeRun& run);

/// The same scene, not yet started.
DenseNodal dense_nodal(const Scene& scene, const std::vector<grid::WallPlane>& walls = {},
                       const Vec3& gravity = Vec3::Zero());

/// Particles with every column.
particles::Particles filled(const LatticeRun& run);
} // namespace support
