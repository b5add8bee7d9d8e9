/// The report of a run as one HTML page that needs no other file: curves, pictures, tables.
#pragma once

#include "io/particle_file.h"
#include "io/run_record.h"
#include "solver/problem.h"
#include "solver/state.h"

#include <optional>
#include <string>
#include <vector>

namespace app
{
struct Report
{
    io::RunRecord record;
    solver::Problem problem;
    std::string resolved; // text of resolved.toml
    std::vector<solver::HistoryLine> history;
    std::vector<std::vector<std::string>> events; // lines of events.csv, the header first; empty: no ligaments
    std::optional<io::ParticleFrame> frame;       // last one, with the fields of `report_fields`
};

/// Fields the report draws where the particle files hold them.
inline const std::vector<std::string> report_fields{"damage", "eq_plastic_strain"};

std::string report_page(const Report& report);
} // namespace app
