#include "app/measure_table.h"

#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app
{
namespace
{
/// That many decimals, but three significant digits at least: what is small is not 0.
std::string decimal_text(Real value, int decimals)
{
    const bool small = value != 0 && std::abs(value) < std::pow(Real(10), 2 - decimals);
    return small ? fmt::format("{:.3g}", value) : fmt::format("{:.{}f}", value, decimals);
}

std::string number_text(const std::string& name, Real value)
{
    if (!std::isfinite(value)) return missing_text(name);
    if (name.ends_with("_N")) return decimal_text(value, 0) + " N";
    if (name.ends_with("_mm")) return decimal_text(value, 2) + " mm";
    return fmt::format("{:.2e}", value);
}

std::string reference_text(const io::Measure& own, const solver::Reference& reference)
{
    if (const auto* path = std::get_if<std::string>(&own.value); path != nullptr)
        return reference.crack_path.empty() ? "-" : reference.crack_path;
    const auto found = reference.measure.find(solver::published_name(own.name));
    if (found == reference.measure.end()) return "-";
    const Real value = std::get<Real>(own.value);
    const std::string text = number_text(own.name, found->second);
    if (!std::isfinite(value) || found->second == 0) return text;
    return fmt::format("{} ({:+.0f} %)", text, 100 * (value / found->second - 1));
}

bool has_target(const io::RunRecord& record, const std::string& name)
{
    return std::any_of(record.targets.begin(), record.targets.end(),
                       [&](const io::Target& target) { return target.name == name; });
}

std::string verdict(const io::Target& target)
{
    if (!target.tolerance) return "";
    return std::abs(target.error) <= *target.tolerance ? "within" : "OUTSIDE";
}

/// Measures of the case beside their references.
std::string target_table(const io::RunRecord& record)
{
    if (record.targets.empty()) return "";
    std::string table =
        fmt::format("\n\n{:<26}{:>14}{:>14}{:>12}{:>12}", "", "this run", "reference", "error", "tolerance");
    for (const io::Target& target : record.targets) {
        const auto own = std::find_if(record.measures.begin(), record.measures.end(),
                                      [&](const io::Measure& m) { return m.name == target.name; });
        const Real value = std::get<Real>(own->value);
        table += fmt::format("\n{:<26}{:>14}{:>14.6g}{:>12}{:>12} {}", target.name,
                             std::isfinite(value) ? fmt::format("{:.6g}", value) : "not reached", target.reference,
                             std::isfinite(value) ? fmt::format("{:.3g}", target.error) : "-",
                             target.tolerance ? fmt::format("{:.3g}", *target.tolerance) : "-", verdict(target));
    }
    return table;
}
} // namespace

bool is_asked(const solver::Problem& problem, const std::string& measure)
{
    if (measure == "peak_force_N") return !problem.force_upper.empty() || !problem.force_lower.empty();
    const auto& events = solver::event_measures;
    const bool of_event = std::find(events.begin(), events.end(), measure) != events.end();
    if (of_event && measure.ends_with("_mean_N") && problem.mean_over <= 0) return false;
    return !problem.ligaments.empty() || !(of_event || measure == "crack_path");
}

std::string missing_text(const std::string& measure)
{
    return measure == "energy_residual" ? "no external work" : "not reached";
}

std::string measure_table(const io::RunRecord& record, const solver::Problem& problem)
{
    const std::vector<solver::Reference>& references = problem.references;
    std::string table = fmt::format("\n{:<18}{:>16}", "", "this run");
    for (const solver::Reference& reference : references) table += fmt::format("{:>26}", reference.name);
    for (const io::Measure& measure : record.measures) {
        if (has_target(record, measure.name) || !is_asked(problem, measure.name)) continue;
        const auto* path = std::get_if<std::string>(&measure.value);
        const std::string own = path == nullptr ? number_text(measure.name, std::get<Real>(measure.value))
                                : path->empty() ? "none"
                                                : *path;
        table += fmt::format("\n{:<18}{:>16}", measure.name, own);
        for (const solver::Reference& reference : references)
            table += fmt::format("{:>26}", reference_text(measure, reference));
    }
    table += target_table(record);
    if (!references.empty()) table += "\n(in brackets: this run against that number)";
    const Real rate = record.wall_s > 0 ? static_cast<Real>(record.particle_steps) / record.wall_s / 1e6 : Real(0);
    return table + fmt::format("\n\n{} after {} steps in {:.1f} s: {:.1f} million particle-steps/s, {:.2f} GB at most",
                               record.exit_reason, record.steps, record.wall_s, rate,
                               static_cast<Real>(record.peak_rss_bytes) / 1e9);
}
} // namespace app
