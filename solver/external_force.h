/// Body forces of motions in closed form and loads on surfaces, put on the nodes at the beginning of a step.
///
/// Trilinear weights at the point where the force acts, whatever the basis: force and moment arrive exactly.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"
#include "solver/step.h"

namespace solver
{
/// Whether a case has any.
bool has_external_forces(const Problem& problem);

/// Forces at the clock's time into `derived.external`, and added to the nodes' sums (halos not yet assembled).
void add_external_forces(const Problem& problem, State& state, Derived& derived);

/// Power of the forces in `derived.external` at half the sum of the node velocities before and after the step, times
/// dt, to state.source_work. Called twice in the nodal scheme: with the velocities before, and with those after.
/// @pre halos of the motion filled
void add_external_work(const Problem& problem, const Derived& derived, State& state);

/// Force of a surface load now, full specimen along `axis` [N].
Real surface_force(const Problem& problem, const Derived& derived, std::size_t load, int axis, Real time);
} // namespace solver
