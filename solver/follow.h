/// Keep leaves, order and load nodes up with the particles (updated formulation; nothing moves in the total one).
#pragma once

#include "solver/step.h"

namespace solver
{
/// Regrid when strays cost more than an ordering or left the present cells; look load nodes up again when a region
/// moved.
void follow_particles(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// Refine where targets ask, split, order, rebuild; then sums and load nodes of the new order.
void regrid(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// Present places of the gauge particles.
void find_gauges(const State& state, Derived& derived);
} // namespace solver
