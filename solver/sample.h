/// The measures a case asks for: sampled while the run goes, reduced to one number each.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"
#include "solver/step.h"

namespace solver
{
/// Value of every measure now, appended to state.samples. Begins the next interval of mean forces.
const Sample& take_sample(const Problem& problem, const Prepared& prepared, const Derived& derived, State& state);

/// One result per measure; NaN where the run does not have it.
std::vector<Real> results(const std::vector<Quantity>& quantities, const std::vector<Sample>& samples);

/// Deviation of a result: value / reference - 1, the value itself where the reference is 0.
Real relative_error(Real value, Real reference);
} // namespace solver
