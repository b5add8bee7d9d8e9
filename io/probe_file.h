/// probes.csv: the values of the case's measures while the run goes, one line per sample, written at once.
#pragma once

#include "solver/quantity.h"
#include "solver/state.h"

#include <filesystem>
#include <vector>

namespace io
{
/// Step, time and the measures' names; ratios of results have no column.
std::string probe_header(const std::vector<solver::Quantity>& quantities);
/// Numbers with 10 significant digits, nan where there is none, without the end of line.
std::string probe_text(const std::vector<solver::Quantity>& quantities, const solver::Sample& sample);
} // namespace io
