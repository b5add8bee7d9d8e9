/// Bodies that begin with a motion in closed form.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
bool begins_with_motion(const Problem& problem);

/// Position, velocity, deformation, stress (and affine velocity) at time 0 of all particles whose body has an `initial`
/// motion, from their rest positions.
void set_initial_state(const Problem& problem, particles::Particles& particles);

/// Velocities half a step earlier, for the scheme keeps them there: v(-dt/2), so that the error in time is of second
/// order. Positions and stress stay at time 0.
/// @pre   not the nodal scheme
void set_back_velocities(const Problem& problem, Real dt, particles::Particles& particles);

/// Displacement at time 0 and velocity half a step earlier on the nodes themselves, each node with the motion of the
/// nearest body.
/// @param dt  of the finest level
/// @pre   the nodal scheme has started; afterwards slaves and halos are filled
void set_node_motion(const Problem& problem, const Prepared& prepared, Real dt, State& state);
} // namespace solver
