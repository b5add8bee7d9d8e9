#include "app/chart_page.h"

#include "app/chart_summary.h"
#include "app/html_table.h"
#include "app/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app
{
namespace
{
using io::ChartRow;

constexpr const char* page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{0}</title><style>
body {{ font-family: sans-serif; max-width: 1000px; margin: 2em auto; color: #222; }}
table {{ border-collapse: collapse; font-size: 90%; }} td, th {{ border: 1px solid #ccc; padding: 2px 8px; text-align: right; }}
td:first-child, th:first-child {{ text-align: left; }} svg {{ max-width: 100%; height: auto; }}
</style></head><body>
<h1>{0}</h1>
<p>Each mark is one run: left is cheaper, lower is more accurate. The line is the Pareto front: the runs that no other beats in
both. The star is the case as Cleave runs it by default, ringed marks the same scheme in other resolutions. Crosses are runs that
failed, became unstable, were given up or did not reach the measure; without an error they stand at the upper edge.</p>
)";

std::string significant(Real value, int digits = 3)
{
    return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
}

std::string percent(Real share)
{
    return std::isfinite(share) ? fmt::format("{:.3g} %", 100 * share) : "-";
}

const TableRow summary_head{"scene",  "settings",       "crosses",   "default: error",
                            "CPU, s", "over the front", "its order", "several levels gain"};

TableRow summary_cells(const SceneSummary& s)
{
    std::string gain = s.two_level_factor ? fmt::format("{:.2g} x", *s.two_level_factor) : "-";
    if (s.beyond_one_level) gain = s.two_level_factor ? gain + ", and further" : "only they reach it";
    std::string settings = std::to_string(s.settings);
    if (s.pending > 0) settings += fmt::format(" ({} pending)", s.pending);
    return {s.scene,
            settings,
            std::to_string(s.crosses),
            percent(s.default_error),
            significant(s.default_cpu_s),
            std::isfinite(s.default_over_front) ? fmt::format("{:.2f}", s.default_over_front) : "-",
            s.order ? fmt::format("{:.1f}", *s.order) : "-",
            gain};
}

std::vector<TableRow> summary_rows(const std::vector<ChartRow>& rows)
{
    std::vector<TableRow> cells;
    for (const SceneSummary& summary : summarise(rows)) cells.push_back(summary_cells(summary));
    return cells;
}

std::string runs_table(const std::vector<const ChartRow*>& rows)
{
    std::vector<TableRow> cells;
    for (const ChartRow* row : rows)
        cells.push_back({row->setting + (row->role == "default" ? " (the case as it is)" : ""), row->status,
                         percent(row->error), significant(row->cpu_s), significant(row->cost_over_front),
                         significant(row->particle_steps, 4), significant(row->peak_rss_bytes / 1e6), row->reason});
    return html_table({"setting", "status", "error", "CPU, s", "over the front", "particle-steps", "memory, MB", ""},
                      cells);
}
} // namespace

std::string chart_page(const std::string& title, const std::vector<ChartRow>& rows,
                       const std::map<std::string, std::string>& titles,
                       const std::map<std::string, std::string>& pictures)
{
    std::string html = fmt::format(page_head, escape_xml(title)) + html_table(summary_head, summary_rows(rows));
    html += fmt::format("<p>Processor time in seconds, user and system, one thread. Cleave {}.</p>\n", CLEAVE_VERSION);
    for (const SceneSummary& summary : summarise(rows)) {
        const auto found = titles.find(summary.scene);
        html += fmt::format("<h2>{}</h2>\n", escape_xml(found == titles.end() ? summary.scene : found->second));
        if (const auto picture = pictures.find(summary.scene); picture != pictures.end())
            html += "<p>" + picture->second + "</p>\n";
        std::vector<const ChartRow*> front, all;
        for (const ChartRow& row : rows)
            if (row.scene == summary.scene) all.push_back(&row);
        std::stable_sort(all.begin(), all.end(), [](const ChartRow* a, const ChartRow* b) {
            return (std::isfinite(a->cpu_s) ? a->cpu_s : 1e300) < (std::isfinite(b->cpu_s) ? b->cpu_s : 1e300);
        });
        std::copy_if(all.begin(), all.end(), std::back_inserter(front),
                     [](const ChartRow* row) { return row->front > 0; });
        html += "<p>On the front:</p>\n" + runs_table(front);
        html += "<details><summary>all runs</summary>\n" + runs_table(all) + "</details>\n";
    }
    return html + "</body></html>\n";
}

std::string chart_text(const std::vector<ChartRow>& rows)
{
    std::vector<TableRow> cells = summary_rows(rows);
    cells.insert(cells.begin(), summary_head);
    std::vector<std::size_t> width(summary_head.size());
    for (const TableRow& row : cells)
        for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    std::string text;
    for (const TableRow& row : cells) {
        for (std::size_t c = 0; c < row.size(); ++c)
            text += c == 0 ? fmt::format("{:<{}}", row[c], width[c]) : fmt::format("  {:>{}}", row[c], width[c]);
        text += "\n";
    }
    return text;
}

std::string chart_markdown(const std::vector<ChartRow>& rows)
{
    std::string text = fmt::format("| {} |\n|{}\n", fmt::join(summary_head, " | "), [] {
        std::string rule;
        for (std::size_t c = 0; c < summary_head.size(); ++c) rule += c == 0 ? "---|" : "---:|";
        return rule;
    }());
    for (const TableRow& row : summary_rows(rows)) text += fmt::format("| {} |\n", fmt::join(row, " | "));
    return text;
}
} // namespace app
