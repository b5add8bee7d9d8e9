/// Case files run in a test, with their measures.
#pragma once

#include "io/case.h"
#include "solver/observe.h"
#include "solver/sample.h"
#include "tests/support/runs.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace support
{
using Results = std::map<std::string, Real>;

/// Whether a multiple of `every` went by in the last step.
inline bool due(const solver::OutputEvery& every, const solver::Clock& clock)
{
    if (every.steps && clock.step % *every.steps == 0) return true;
    if (!every.time) return false;
    const auto count = [&](Real time) { return std::floor(time / *every.time * (1 + 1e-12)); };
    return count(clock.time) > count(clock.time - clock.dt);
}

/// Run to the end, measures sampled as the program does it; results by name.
inline Results results_of(Job& run)
{
    const solver::Problem& problem = run.problem;
    const auto sample = [&] { solver::take_sample(problem, run.prepared, run.derived, run.state); };
    const solver::OutputEvery& own = problem.output.probes;
    const solver::OutputEvery& every = own.time || own.steps ? own : problem.output.history;
    sample();
    while (solver::finished(problem, run.state) == solver::Finish::no) {
        advance(1, run);
        if (due(every, run.state.clock)) sample();
    }
    if (run.state.samples.back().step != run.state.clock.step) sample();
    const std::vector<Real> values = solver::results(problem.quantities, run.state.samples);
    Results results;
    for (std::size_t i = 0; i < values.size(); ++i) results[problem.quantities[i].name] = values[i];
    return results;
}

/// A case below cases/ with overrides such as "grid.cell=0.5".
inline Results results_of(const std::string& file, const std::vector<std::string>& overrides)
{
    Job run = started(io::read_case(std::string(CLEAVE_SOURCE_DIR) + "/cases/" + file, overrides));
    return results_of(run);
}
} // namespace support
