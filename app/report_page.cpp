#include "app/report_page.h"

#include "app/html_table.h"
#include "app/measure_table.h"
#include "app/svg_chart.h"
#include "app/svg_field.h"
#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace app
{
namespace
{
constexpr std::array<const char*, 4> reference_colours{"#c0392b", "#8e44ad", "#d68910", "#117864"};

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{}</title><style>
body {{ font-family: sans-serif; max-width: 860px; margin: 2em auto; color: #222; }}
table {{ border-collapse: collapse; }} td, th {{ border: 1px solid #ccc; padding: 3px 10px; text-align: right; }}
td:first-child, th:first-child {{ text-align: left; }} pre {{ background: #f5f5f5; padding: 1em; overflow: auto; }}
</style></head><body>
<h1>{}</h1>
)";

using Row = TableRow;

std::string number(Real value)
{
    return std::isfinite(value) ? fmt::format("{:.5g}", value) : "not reached";
}

std::string total(const std::vector<std::uint64_t>& per_level)
{
    std::string text;
    for (std::size_t l = 0; l < per_level.size(); ++l) text += fmt::format("{}L{}: {}", l ? ", " : "", l, per_level[l]);
    return text;
}

/// Points (opening, force) of a reference: every pair <event>_cod_mm, <event>_force_N.
ChartSeries reference_points(const solver::Reference& reference, const std::string& colour)
{
    ChartSeries series{reference.name, colour, ChartSeries::Mark::points, {}, {}};
    constexpr std::string_view ending = "_cod_mm";
    for (const auto& [name, cod] : reference.measure) {
        if (!name.ends_with(ending)) continue;
        const std::string event = name.substr(0, name.size() - ending.size());
        const auto force = reference.measure.find(event + "_force_N");
        if (force == reference.measure.end()) continue;
        series.x.push_back(cod);
        series.y.push_back(force->second);
        series.names.push_back(event);
    }
    return series;
}

std::string force_chart(const Report& report)
{
    ChartSeries upper{"force, upper", "#1f5fa8", ChartSeries::Mark::line, {}, {}};
    ChartSeries lower{"force, lower", "#7fb2e5", ChartSeries::Mark::line, {}, {}};
    for (const solver::HistoryLine& line : report.history) {
        upper.x.push_back(line.cod);
        upper.y.push_back(line.force_upper);
        lower.y.push_back(line.force_lower);
    }
    lower.x = upper.x;
    Chart chart{"opening (COD) [mm]", "force [N]", {lower, upper}};
    const double widest = upper.x.empty() ? 0 : *std::max_element(upper.x.begin(), upper.x.end());
    for (std::size_t r = 0; r < report.record.references.size(); ++r) {
        const solver::Reference& reference = report.record.references[r];
        const std::string colour = reference_colours[r % reference_colours.size()];
        const ChartSeries points = reference_points(reference, colour);
        if (const auto peak = reference.measure.find("peak_force_N"); peak != reference.measure.end() && widest > 0)
            chart.series.push_back({reference.name + ", peak",
                                    colour,
                                    ChartSeries::Mark::line,
                                    {0, widest},
                                    {peak->second, peak->second}});
        if (!points.x.empty()) chart.series.push_back(points);
    }
    return svg_chart(chart);
}

std::string energy_chart(const std::vector<solver::HistoryLine>& history)
{
    struct Curve
    {
        const char* label;
        const char* colour;
        Real (*value)(const solver::Ledger&);
    };
    constexpr std::array<Curve, 6> curves{{
        {"external work", "#222222", [](const solver::Ledger& e) { return e.external; }},
        {"kinetic", "#2e86c1", [](const solver::Ledger& e) { return e.kinetic; }},
        {"elastic", "#28b463", [](const solver::Ledger& e) { return e.elastic; }},
        {"plastic", "#d68910", [](const solver::Ledger& e) { return e.plastic; }},
        {"decohesion", "#c0392b", [](const solver::Ledger& e) { return e.decohesion; }},
        {"residual", "#999999", [](const solver::Ledger& e) { return e.residual(); }},
    }};
    Chart chart{"time [ms]", "energy of the modelled part [mJ]", {}};
    for (const Curve& curve : curves) {
        ChartSeries series{curve.label, curve.colour, ChartSeries::Mark::line, {}, {}};
        for (const solver::HistoryLine& line : history) {
            series.x.push_back(line.time);
            series.y.push_back(curve.value(line.energy));
        }
        chart.series.push_back(std::move(series));
    }
    return svg_chart(chart);
}

std::string measure_table(const Report& report)
{
    Row head{"measure", "this run"};
    for (const solver::Reference& reference : report.record.references) head.push_back(reference.name);
    std::vector<Row> rows;
    for (const io::Measure& measure : report.record.measures) {
        if (!is_asked(report.problem, measure.name)) continue;
        const bool text = std::holds_alternative<std::string>(measure.value);
        const Real value = text ? Real(NAN) : std::get<Real>(measure.value);
        Row row{measure.name, text                   ? std::get<std::string>(measure.value)
                              : std::isfinite(value) ? number(value)
                                                     : missing_text(measure.name)};
        for (const solver::Reference& reference : report.record.references) {
            const auto published = reference.measure.find(solver::published_name(measure.name));
            if (measure.name == "crack_path")
                row.push_back(reference.crack_path);
            else if (published == reference.measure.end())
                row.emplace_back("");
            else if (const Real other = published->second; std::isfinite(value) && other != 0)
                row.push_back(fmt::format("{:.5g} ({:+.1f} %)", other, 100 * (value / other - 1)));
            else
                row.push_back(number(other));
        }
        rows.push_back(std::move(row));
    }
    return html_table(head, rows);
}

std::string run_table(const io::RunRecord& record)
{
    const Real speed = record.wall_s > 0 ? static_cast<Real>(record.particle_steps) / record.wall_s : 0;
    const std::string status = record.status + (record.exit_reason.empty() ? "" : ": " + record.exit_reason);
    return html_table({}, {{"status", status},
                           {"version", record.version},
                           {"compiler", record.compiler},
                           {"instruction set", record.instruction_set},
                           {"threads", std::to_string(record.threads)},
                           {"wall time", fmt::format("{:.1f} s", record.wall_s)},
                           {"processor time", fmt::format("{:.1f} s", record.cpu_s)},
                           {"steps", std::to_string(record.steps)},
                           {"particle-steps per second", fmt::format("{:.3g} million", speed / 1e6)},
                           {"peak memory", fmt::format("{:.2f} GB", static_cast<double>(record.peak_rss_bytes) / 1e9)},
                           {"particles at the start", total(record.particles_start)},
                           {"particles at the end", total(record.particles_end)}});
}

std::string zone_table(const std::vector<solver::Zone>& zones)
{
    std::vector<Row> rows;
    for (const solver::Zone& zone : zones)
        rows.push_back({zone.name, std::to_string(zone.level), fmt::format("{:g}", zone.margin)});
    return html_table({"zone", "level", "margin [mm]"}, rows);
}

/// Middle of the thickness of the full specimen: a symmetry plane across the thinnest direction that bounds the
/// particles, else the centre of their range.
Real middle(const solver::Problem& problem, int axis, float low, float high)
{
    for (const solver::SymmetryPlane& plane : problem.symmetry) {
        const Real to_low = std::abs(plane.at - low), to_high = std::abs(plane.at - high);
        if (plane.axis == axis && std::min(to_low, to_high) < Real(0.25) * (high - low)) return plane.at;
    }
    return (static_cast<Real>(low) + static_cast<Real>(high)) / 2;
}

/// The particles nearest to the middle plane: one layer of each size.
FieldPicture section(const io::ParticleFrame& frame, const solver::Problem& problem, const std::string& field)
{
    std::array<float, 3> low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [least, most] = std::minmax_element(frame.position[a].begin(), frame.position[a].end());
        low[a] = *least;
        high[a] = *most;
    }
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
        if (high[a] - low[a] <= high[axis] - low[axis]) axis = a;
    const std::size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const Real at = middle(problem, static_cast<int>(axis), low[axis], high[axis]);
    const std::vector<float>& values = frame.scalar.at(field);
    FieldPicture picture;
    picture.label = fmt::format("{} at t = {:.4g} ms, {} = {:.4g} mm", field, frame.time, "xyz"[axis], at);
    for (std::size_t p = 0; p < values.size(); ++p) {
        // 0.75 and not 0.5 of the side: the thinned metal has left its place by some of it
        if (std::abs(frame.position[axis][p] - at) > Real(0.75) * frame.side[p]) continue;
        picture.u.push_back(frame.position[u][p]);
        picture.v.push_back(frame.position[v][p]);
        picture.side.push_back(frame.side[p]);
        picture.value.push_back(values[p]);
    }
    return picture;
}

std::string pictures(const Report& report)
{
    if (!report.frame || report.frame->side.empty()) return "<p>There is no particle file to draw.</p>\n";
    std::string html;
    for (const std::string& field : report_fields) {
        if (report.frame->scalar.count(field) == 0)
            html += "<p>The particle files do not hold " + field + ".</p>\n";
        else
            html += "<p>" + svg_field(section(*report.frame, report.problem, field)) + "</p>\n";
    }
    return html;
}
} // namespace

std::string report_page(const Report& report)
{
    const std::string title = escape_xml(report.record.title);
    std::string html = fmt::format(page_head, title, title);
    html += run_table(report.record);
    if (report.problem.symmetry_factor(report.problem.force_axis) != 1)
        html += fmt::format("<p>Forces are those of the full specimen: {:g} times the modelled part.</p>\n",
                            report.problem.symmetry_factor(report.problem.force_axis));
    html += "<h2>Force and opening</h2>\n" + force_chart(report);
    html += "<h2>Measures</h2>\n" + measure_table(report);
    if (!report.events.empty())
        html += "<h2>Events on the ligaments</h2>\n" +
                html_table(report.events[0], {report.events.begin() + 1, report.events.end()});
    html += "<h2>Fields in the mid-plane</h2>\n" + pictures(report);
    html += "<h2>Energies</h2>\n" + energy_chart(report.history);
    html += "<h2>Refinement zones</h2>\n" + zone_table(report.problem.zones);
    html += "<h2>What was modelled</h2>\n<ul>\n";
    for (const std::string& line : report.record.modelled) html += "<li>" + escape_xml(line) + "</li>\n";
    html +=
        "</ul>\n<details><summary>resolved.toml</summary><pre>" + escape_xml(report.resolved) + "</pre></details>\n";
    return html + "</body></html>\n";
}
} // namespace app
