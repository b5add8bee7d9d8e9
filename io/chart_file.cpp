#include "io/chart_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <variant>

namespace io
{
namespace
{
struct Column
{
    const char* name;
    std::variant<std::string ChartRow::*, Real ChartRow::*> member;
};

const std::array columns{
    Column{"scene", &ChartRow::scene},
    Column{"case", &ChartRow::file},
    Column{"setting", &ChartRow::setting},
    Column{"scheme", &ChartRow::scheme},
    Column{"role", &ChartRow::role},
    Column{"status", &ChartRow::status},
    Column{"exit_code", &ChartRow::exit_code},
    Column{"error", &ChartRow::error},
    Column{"stability", &ChartRow::stability},
    Column{"cpu_s", &ChartRow::cpu_s},
    Column{"wall_s", &ChartRow::wall_s},
    Column{"steps", &ChartRow::steps},
    Column{"particle_steps", &ChartRow::particle_steps},
    Column{"peak_rss_bytes", &ChartRow::peak_rss_bytes},
    Column{"particles", &ChartRow::particles},
    Column{"cell_mm", &ChartRow::cell_mm},
    Column{"finest_mm", &ChartRow::finest_mm},
    Column{"levels", &ChartRow::levels},
    Column{"particles_per_cell", &ChartRow::particles_per_cell},
    Column{"formulation", &ChartRow::formulation},
    Column{"basis", &ChartRow::basis},
    Column{"transfer", &ChartRow::transfer},
    Column{"stress_update", &ChartRow::stress_update},
    Column{"precision", &ChartRow::precision},
    Column{"pic_fraction", &ChartRow::pic_fraction},
    Column{"cfl", &ChartRow::cfl},
    Column{"length_mm", &ChartRow::length_mm},
    Column{"contact", &ChartRow::contact},
    Column{"large_motion", &ChartRow::large_motion},
    Column{"plastic", &ChartRow::plastic},
    Column{"crack", &ChartRow::crack},
    Column{"localised", &ChartRow::localised},
    Column{"front", &ChartRow::front},
    Column{"cost_over_front", &ChartRow::cost_over_front},
    Column{"version", &ChartRow::version},
    Column{"overrides", &ChartRow::overrides},
    Column{"reason", &ChartRow::reason},
};

std::string cell_text(const ChartRow& row, const Column& column)
{
    if (const auto* text = std::get_if<std::string ChartRow::*>(&column.member)) return row.**text;
    const Real value = row.*std::get<Real ChartRow::*>(column.member);
    return std::isfinite(value) ? fmt::format("{:.7g}", value) : "";
}

bool read_cell(const std::string& cell, const Column& column, ChartRow& row)
{
    if (const auto* text = std::get_if<std::string ChartRow::*>(&column.member)) {
        row.** text = cell;
        return true;
    }
    Real& value = row.*std::get<Real ChartRow::*>(column.member);
    value = ChartRow::none;
    if (cell.empty()) return true;
    const auto [end, problem] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return problem == std::errc() && end == cell.data() + cell.size();
}
} // namespace

void write_chart(const std::filesystem::path& path, const std::vector<ChartRow>& rows)
{
    std::vector<std::string> cells;
    for (const Column& column : columns) cells.emplace_back(column.name);
    std::string text = csv_line(cells) + "\n";
    for (const ChartRow& row : rows) {
        cells.clear();
        for (const Column& column : columns) cells.push_back(cell_text(row, column));
        text += csv_line(cells) + "\n";
    }
    write_file(path, text);
}

std::vector<ChartRow> read_chart(const std::filesystem::path& path)
{
    const std::vector<std::vector<std::string>> lines = csv_cells(read_file(path));
    const auto bad = [&](std::size_t line, const std::string& what) {
        return core::FileError(fmt::format("cannot read '{}': line {} {}", path.string(), line, what));
    };
    std::vector<ChartRow> rows;
    if (lines.empty()) throw bad(1, "is not the header of a chart");
    // By name, so that a table of another version with more columns, or in another order, can still be read.
    std::vector<const Column*> order;
    for (const std::string& name : lines[0]) {
        const auto found =
            std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
        order.push_back(found == columns.end() ? nullptr : &*found);
    }
    for (const char* needed : {"scene", "scheme", "status", "error", "cpu_s", "finest_mm", "length_mm"})
        if (std::find(lines[0].begin(), lines[0].end(), needed) == lines[0].end())
            throw bad(1, fmt::format("has no column '{}': this is not a table of `cleave chart`", needed));
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (lines[i].size() != order.size()) throw bad(i + 1, fmt::format("has not {} cells", order.size()));
        ChartRow& row = rows.emplace_back();
        for (std::size_t c = 0; c < order.size(); ++c)
            if (order[c] && !read_cell(lines[i][c], *order[c], row))
                throw bad(i + 1, fmt::format("has '{}' in column {}", lines[i][c], order[c]->name));
    }
    return rows;
}
} // namespace io
