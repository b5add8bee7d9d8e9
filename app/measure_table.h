/// The table at the end of a run: this run beside published numbers.
#pragma once

#include "io/run_record.h"
#include "solver/problem.h"

#include <string>

namespace app
{
/// One row per measure, one column for this run and each reference; deviations in percent.
std::string measure_table(const io::RunRecord& record, const std::vector<solver::Reference>& references);
} // namespace app
