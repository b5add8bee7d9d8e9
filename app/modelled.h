/// "It models no more than the scene needs": what was active in a run and why, one sentence each.
#pragma once

#include "solver/problem.h"
#include "solver/state.h"

#include <string>
#include <vector>

namespace app
{
std::vector<std::string> modelled(const solver::Problem& problem, const solver::State& state);
} // namespace app
