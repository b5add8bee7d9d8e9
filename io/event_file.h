/// events.csv: what happened on which ligament, when, at which force and opening; units stand in the header.
///
/// A few lines per ligament, so the file is written anew, as a whole, whenever something happened: it always agrees
/// with the state, also after a restart.
#pragma once

#include "solver/problem.h"
#include "solver/state.h"

#include <filesystem>
#include <string>
#include <vector>

namespace io
{
/// The whole file: step,time_ms,ligament,event,front,force_N,cod_mm,initiation. `initiation` is c1, c2, ... on the
/// lines from which the measures take the crack initiations (solver/measures.h), else empty.
std::string events_text(const solver::Problem& problem, const solver::State& state);

/// Cells of every line, the header first.
/// @error FileError if the file cannot be read
std::vector<std::vector<std::string>> read_events(const std::filesystem::path& path);
} // namespace io
