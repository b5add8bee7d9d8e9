/// Levels full of particles, below the solver: what the particle passes are tested on.
#pragma once

#include "material/material.h"
#include "tests/support/random.h"
#include "tests/support/topologies.h"
#include "transfer/passes.h"

namespace support
{
struct Scene
{
    transfer::PassOptions options;
    transfer::LawTable laws;
    grid::Refinement refinement;
    grid::Levels levels;
    particles::Particles particles;
    transfer::Strays strays;
    std::vector<transfer::LeafWork> leaf_work; // mJ, of the last step
    Real plastic_work = 0;                     // mJ, of all steps by `advance`
};

/// Where the particles of a cell sit.
enum class Layout
{
    regular, // 2^3, at the centres of the sub-cells: each node sees every cell symmetrically
    random,  // 1 to 20, anywhere in the cell, of any material
};

/// E = 1000 MPa, nu = 0.3, 1e-3 g/mm^3, elastic.
material::Material soft_elastic();

/// The soft one with plasticity from `yield_stress` [MPa] on, and a harder, elastic one.
std::vector<material::Material> two_metals(Real yield_stress, bool averaged);

/// Fill the cells of a topology; stress 0, velocity 0, F = I, weights and state of the wanted scheme.
Scene scene_of(const Topology& topology, const transfer::PassOptions& options,
               const std::vector<material::Material>& materials, Layout layout, std::uint64_t seed = 1);

/// Random velocity, affine matrix and symmetric stress on every particle.
void randomise_state(std::uint64_t seed, Scene& scene);

/// Updated formulation: move every particle by up to a third of its cell, without ordering. Some are strays then.
void disturb(std::uint64_t seed, Scene& scene);

/// Build the leaves for where the particles are now and order them.
void order(Scene& scene);

/// P2G with everything before the momentum update: sums of free nodes complete, slaves empty.
void gather_sums(Scene& scene);

/// Velocity (and change) of the free nodes by position, carried to slaves and halos.
void prescribe_motion(const std::function<Vec3(const Vec3&)>& velocity, grid::Levels& levels);

/// One step of free motion, reordering when the strays ask for it.
void advance(Real dt, Scene& scene);

Vec3 vector_of(const std::array<particles::Column, 3>& columns, std::size_t p);
Eigen::Matrix3d matrix_of(const std::array<particles::Column, 9>& columns, std::size_t p);
Eigen::Matrix3d stress_of(const particles::Particles& particles, std::size_t p);
Vec3 vector_of(const std::array<Real, 3>& values);

/// Formulations with their bases; in the total one boxes are points.
struct Weights
{
    transfer::Formulation formulation;
    transfer::Basis basis;
};
inline constexpr Weights all_weights[] = {{transfer::Formulation::updated, transfer::Basis::trilinear},
                                          {transfer::Formulation::updated, transfer::Basis::gimp},
                                          {transfer::Formulation::total, transfer::Basis::trilinear}};
} // namespace support
