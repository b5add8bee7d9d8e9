#include "io/event_file.h"

#include "io/atomic_file.h"
#include "io/csv.h"
#include "solver/ligament_events.h"
#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
/// "c2" where the event is the second crack initiation.
std::string initiation_name(const std::vector<std::size_t>& initiations, const solver::LigamentEvent& event)
{
    if (event.kind != solver::EventKind::first) return "";
    const auto found = std::find(initiations.begin(), initiations.end(), static_cast<std::size_t>(event.ligament));
    return found == initiations.end() ? "" : fmt::format("c{}", found - initiations.begin() + 1);
}
} // namespace

std::string events_text(const solver::Problem& problem, const solver::State& state)
{
    const std::vector<std::size_t> initiations = solver::crack_initiations(problem, state.ligaments);
    std::string text = "step,time_ms,ligament,event,front,force_N,cod_mm,initiation\n";
    for (const solver::LigamentEvent& event : state.events) {
        const solver::Ligament& ligament = problem.ligaments[static_cast<std::size_t>(event.ligament)];
        text += csv_line({std::to_string(event.step), fmt::format("{:.10g}", event.time),
                          fmt::format("{}-{}", ligament.from, ligament.to), std::string(solver::event_name(event.kind)),
                          fmt::format("{:.4g}", event.front), fmt::format("{:.10g}", event.force),
                          fmt::format("{:.10g}", event.cod), initiation_name(initiations, event)}) +
                "\n";
    }
    return text;
}

std::vector<std::vector<std::string>> read_events(const std::filesystem::path& path)
{
    return csv_cells(read_file(path));
}
} // namespace io
