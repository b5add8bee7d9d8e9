#include "solver/measures.h"

#include "solver/ligaments.h"

#include <algorithm>
#include <utility>

namespace solver
{
namespace
{
std::vector<std::size_t> initiations(const Problem& problem, const std::vector<LigamentState>& states,
                                     const CrackPath& path)
{
    std::vector<std::size_t> events = path.ligaments;
    const std::vector<std::string> ends =
        path.features.empty() ? problem.start_features : std::vector<std::string>{path.features.back()};
    const auto is_end = [&](const std::string& name) {
        return std::find(ends.begin(), ends.end(), name) != ends.end();
    };
    const auto is_visited = [&](const std::string& name) {
        return std::find(path.features.begin(), path.features.end(), name) != path.features.end();
    };
    std::optional<std::size_t> next; // begun at the end of the path, not yet separated
    for (std::size_t i = 0; i < states.size(); ++i) {
        const Ligament& ligament = problem.ligaments[i];
        const bool continues =
            (is_end(ligament.from) && !is_visited(ligament.to)) || (is_end(ligament.to) && !is_visited(ligament.from));
        if (!continues || states[i].first_time < 0) continue;
        // Where holes lie close, a column at the rim of one belongs to more than one ligament: the one cut furthest
        // counts.
        const auto rank = [&](std::size_t n) { return std::pair(-states[n].front, states[n].first_time); };
        if (!next || rank(i) < rank(*next)) next = i;
    }
    if (next) events.push_back(*next);
    std::stable_sort(events.begin(), events.end(),
                     [&](std::size_t a, std::size_t b) { return states[a].first_time < states[b].first_time; });
    return events;
}

/// Mean of the forces [N] over the opening `problem.mean_over` before the first broken column of a ligament.
std::optional<Real> mean_force_before(const Problem& problem, const std::vector<HistoryLine>& history,
                                      const LigamentState& ligament)
{
    if (problem.mean_over <= 0) return std::nullopt;
    Real sum = 0;
    int count = 0;
    for (const HistoryLine& line : history) {
        if (line.time > ligament.first_time) break;
        if (line.cod <= ligament.first_cod - problem.mean_over) continue;
        sum += specimen_force(problem, line.force_upper, line.force_lower);
        ++count;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}
} // namespace

std::vector<std::size_t> crack_initiations(const Problem& problem, const std::vector<LigamentState>& ligaments)
{
    if (ligaments.empty()) return {};
    return initiations(problem, ligaments, crack_path(problem.ligaments, ligaments, problem.start_features));
}

std::vector<std::string> measure_names(const Problem& problem)
{
    std::vector<std::string> names;
    const std::vector<LigamentState> intact(problem.ligaments.size());
    for (const Measure& measure : measures(problem, {}, intact).numbers) names.push_back(measure.name);
    for (const Quantity& quantity : problem.quantities) names.push_back(quantity.name);
    return names;
}

std::string published_name(const std::string& measure)
{
    constexpr std::string_view mean = "_mean_N";
    return measure.ends_with(mean) ? measure.substr(0, measure.size() - mean.size()) + "_force_N" : measure;
}

Real specimen_force(const Problem& problem, Real force_upper, Real force_lower)
{
    if (problem.force_lower.empty()) return force_upper;
    if (problem.force_upper.empty()) return force_lower;
    return 0.5 * (force_upper + force_lower);
}

Measures measures(const Problem& problem, const std::vector<HistoryLine>& history,
                  const std::vector<LigamentState>& ligaments)
{
    Measures result;
    std::optional<Real> peak;
    for (const HistoryLine& line : history) {
        const Real force = specimen_force(problem, line.force_upper, line.force_lower);
        if (!peak || force > *peak) peak = force;
    }
    result.numbers.push_back({"peak_force_N", peak});

    const std::vector<std::size_t> events = crack_initiations(problem, ligaments);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string name = "c" + std::to_string(k + 1);
        std::optional<Real> force, mean, cod;
        if (k < events.size()) {
            const LigamentState& ligament = ligaments[events[k]];
            force = ligament.first_force;
            mean = mean_force_before(problem, history, ligament);
            cod = ligament.first_cod;
        }
        result.numbers.push_back({name + "_force_N", force});
        result.numbers.push_back({name + "_mean_N", mean});
        result.numbers.push_back({name + "_cod_mm", cod});
    }

    std::optional<Real> residual;
    if (!history.empty() && history.back().energy.external != 0)
        residual = history.back().energy.residual() / history.back().energy.external;
    result.numbers.push_back({"energy_residual", residual});
    if (!ligaments.empty())
        result.crack_path = path_name(crack_path(problem.ligaments, ligaments, problem.start_features));
    return result;
}
} // namespace solver
