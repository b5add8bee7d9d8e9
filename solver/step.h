/// One time step of all levels, and the run's beginning.
#pragma once

#include "grid/fast_nodes.h"
#include "solver/ligaments.h"
#include "solver/loads.h"
#include "solver/prepared.h"
#include "solver/state.h"
#include "solver/surface.h"
#include "transfer/nonlocal_onset.h"

#include <vector>

namespace solver
{
/// What follows from State and is rebuilt rather than stored: after start, restart and every ordering.
struct Derived
{
    std::vector<LoadNodes> load_nodes;
    std::vector<std::uint32_t> gauge_upper, gauge_lower; // present places of the gauge particles
    LigamentMap ligaments;
    SurfaceForces surface;
    std::vector<Vec3> external;       // [leaf][729] N, scratch: forces of this step that are not internal
    std::vector<std::uint8_t> pushed; // [leaf] 1: it has some; else its tile of `external` says nothing
    transfer::NonlocalTable nonlocal;
    grid::FastNodes fast_nodes; // sub-cycling only
};

/// Particles, leaves and sums at time 0.
/// @error core::InputError if a body has no particle, a load holds no node or a gauge finds no particle
State initialise(const Problem& problem, const Prepared& prepared, Derived& derived);

/// Rebuild everything that a checkpoint does not hold: leaves, strays, load nodes, sums.
/// @param state  reads particles in stored order, levels as io/checkpoint.h restores them
void resume(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// Advance by one time step: symplectic Euler, stress updated last, all levels with the same dt. With `musl` the stress
/// comes from velocities mapped again from the updated particles.
///
/// | phase                         | reads                               | writes                           |
/// |-------------------------------|-------------------------------------|----------------------------------|
/// | stable_time_step              | speeds, deformation, spacing        | dt                               |
/// | add_external_forces           | particles, clock                    | sums (cases that have some)      |
/// | grid::assemble_sums           | halo sums of neighbours             | sums of owned nodes              |
/// | grid::restrict_sums           | sums of slaves                      | sums of masters                  |
/// | grid::advance_momentum        | mass, momentum, force               | node velocity and its change     |
/// | damp_nodes                    | node velocity and its change        | both (cases with damping)        |
/// | apply_loads                   | sums of held nodes                  | their velocity; reactions        |
/// | grid::prolong_motion          | velocity of masters                 | velocity of slaves               |
/// | grid::fill_motion_halos       | velocity of owners                  | velocity of halos                |
/// | transfer::remap_momentum      | node velocity, particles            | momentum (musl), then the nodes  |
/// | transfer::advance_and_scatter | node velocity, particles            | particles; sums of the next step |
/// | start_nonlocal_cracks         | stress, node velocity               | cracks that start                |
/// | follow_particles              | strays                              | order of particles, leaves       |
void step(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// The same with velocity and displacement kept on the nodes: only forces go there, only gradients come back.
void step_nodal(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// The same with sub-cycling (methods.md A.7): one step of the coarsest level, 2^(l_max - l) dt for level l. Nested
/// impulses: what a level's particles push is given to the nodes at once, at the beginning of that level's step; every
/// such impulse sums to zero, so momentum does not change. Strain comes from the displacement of the nodes over the
/// step, at its end. Loads act in every step of the finest level.
void step_subcycled(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// The step the case asks for.
void advance(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);
} // namespace solver
