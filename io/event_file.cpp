#include "io/event_file.h"

#include "io/atomic_file.h"
#include "solver/ligament_events.h"
#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

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
        text += fmt::format("{},{:.10g},{}-{},{},{:.4g},{:.10g},{:.10g},{}\n", event.step, event.time, ligament.from,
                            ligament.to, solver::event_name(event.kind), event.front, event.force, event.cod,
                            initiation_name(initiations, event));
    }
    return text;
}

std::vector<std::vector<std::string>> read_events(const std::filesystem::path& path)
{
    std::vector<std::vector<std::string>> rows;
    std::istringstream text(read_file(path));
    for (std::string line; std::getline(text, line);) {
        std::vector<std::string>& row = rows.emplace_back();
        std::size_t begin = 0;
        for (std::size_t end = line.find(','); end != line.npos; end = line.find(',', begin)) {
            row.push_back(line.substr(begin, end - begin));
            begin = end + 1;
        }
        row.push_back(line.substr(begin));
    }
    return rows;
}
} // namespace io
