/// The table at the end of a run: this run beside published numbers.
#pragma once

#include "io/run_record.h"
#include "solver/problem.h"

#include <string>

namespace app
{
/// False for what every run.json names but a case does not ask: cracks without ligaments, forces without loads.
bool is_asked(const solver::Problem& problem, const std::string& measure);

/// What a table shows instead of a number that a run does not have.
std::string missing_text(const std::string& measure);

/// One row per measure that the case asks, one column for this run and each reference; deviations in percent.
std::string measure_table(const io::RunRecord& record, const solver::Problem& problem);
} // namespace app
