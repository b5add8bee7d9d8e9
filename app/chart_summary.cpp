#include "app/chart_summary.h"

#include <algorithm>
#include <cmath>

namespace app
{
namespace
{
using io::ChartRow;

bool done(const ChartRow& row)
{
    return row.status == "done" && row.error > 0 && row.cpu_s > 0;
}

/// Rows that no other of the list beats, from the cheapest to the most accurate.
std::vector<const ChartRow*> front_of(std::vector<const ChartRow*> rows)
{
    std::sort(rows.begin(), rows.end(), [](const ChartRow* a, const ChartRow* b) { return a->cpu_s < b->cpu_s; });
    std::vector<const ChartRow*> front;
    for (const ChartRow* row : rows)
        if (front.empty() || row->error < front.back()->error) front.push_back(row);
    return front;
}

/// Processor time at which a front reaches an error; nothing outside the errors it spans.
std::optional<Real> cost_at(const std::vector<const ChartRow*>& front, Real error)
{
    for (std::size_t i = 1; i < front.size(); ++i) {
        const ChartRow &coarse = *front[i - 1], &fine = *front[i];
        if (error > coarse.error || error < fine.error) continue;
        const Real share = std::log(coarse.error / error) / std::log(coarse.error / fine.error);
        return coarse.cpu_s * std::pow(fine.cpu_s / coarse.cpu_s, share);
    }
    return {};
}

SceneSummary summarise_scene(const std::vector<ChartRow>& rows)
{
    SceneSummary summary;
    summary.scene = rows.front().scene;
    std::vector<Real> h, error;
    const auto standard = std::find_if(rows.begin(), rows.end(), [](const ChartRow& r) { return r.role == "default"; });
    for (const ChartRow& row : rows) {
        if (row.status == "not applicable")
            ++summary.not_applicable;
        else
            ++summary.settings;
        if (row.status == "pending") ++summary.pending;
        if (row.status == "failed" || row.status == "unstable" || row.status == "over limit" ||
            row.status == "not reached")
            ++summary.crosses;
        if (!done(row)) continue;
        if (row.role == "default") {
            summary.default_error = row.error;
            summary.default_cpu_s = row.cpu_s;
            summary.default_over_front = row.cost_over_front;
        }
        if (standard != rows.end() && !row.role.empty() && row.levels == standard->levels) {
            h.push_back(row.finest_mm);
            error.push_back(row.error);
        }
    }
    summary.order = fitted_order(h, error);
    summary.two_level_factor = two_level_factor(rows, summary.beyond_one_level);
    return summary;
}
} // namespace

std::optional<Real> fitted_order(const std::vector<Real>& h, const std::vector<Real>& error)
{
    const auto n = static_cast<Real>(h.size());
    Real x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < h.size(); ++i) {
        const Real u = std::log(h[i]), v = std::log(error[i]);
        x += u, y += v, xx += u * u, xy += u * v;
    }
    const Real spread = n * xx - x * x;
    if (h.size() < 2 || spread < 1e-9 * n * n) return {};
    return (n * xy - x * y) / spread;
}

bool same_method(const ChartRow& a, const ChartRow& b)
{
    return a.formulation == b.formulation && a.basis == b.basis && a.transfer == b.transfer &&
           a.stress_update == b.stress_update && a.precision == b.precision && a.pic_fraction == b.pic_fraction &&
           a.cfl == b.cfl && a.particles_per_cell == b.particles_per_cell;
}

std::optional<Real> two_level_factor(const std::vector<ChartRow>& scene, bool& beyond)
{
    Real logs = 0;
    int count = 0;
    for (const ChartRow& nested : scene) {
        if (!done(nested) || nested.levels < 2) continue;
        std::vector<const ChartRow*> uniform;
        for (const ChartRow& other : scene)
            if (done(other) && other.levels == 1 && other.scheme == nested.scheme && same_method(other, nested))
                uniform.push_back(&other);
        const std::vector<const ChartRow*> front = front_of(uniform);
        if (const std::optional<Real> cost = cost_at(front, nested.error)) {
            logs += std::log(*cost / nested.cpu_s);
            ++count;
        } else if (!front.empty() && nested.error < front.back()->error)
            beyond = true;
    }
    if (count == 0) return {};
    return std::exp(logs / count);
}

std::vector<SceneSummary> summarise(const std::vector<ChartRow>& rows)
{
    std::vector<SceneSummary> all;
    for (std::size_t begin = 0; begin < rows.size();) {
        std::size_t end = begin;
        while (end < rows.size() && rows[end].scene == rows[begin].scene) ++end;
        all.push_back(summarise_scene(
            {rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.begin() + static_cast<std::ptrdiff_t>(end)}));
        begin = end;
    }
    return all;
}
} // namespace app
