/// Damping (grid/damping.h) of what no load holds, for ends that are quasi-static.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"
#include "solver/step.h"

namespace solver
{
/// By numerics.damping and numerics.damping_memory; the work it takes goes to state.damped_work.
/// @pre momentum advanced, loads not yet applied: they prescribe what the nodes they hold do, damped or not
void damp_nodes(const Problem& problem, const Derived& derived, State& state);
} // namespace solver
