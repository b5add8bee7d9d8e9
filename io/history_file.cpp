#include "io/history_file.h"

#include "core/error.h"
#include "io/atomic_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <string_view>

namespace io
{
namespace
{
using solver::HistoryLine;

struct RealColumn
{
    const char* name;
    Real& (*value)(HistoryLine&);
};

/// The real-valued columns between `step` and `separated_particles`; `residual_mJ` follows from the others.
constexpr std::array<RealColumn, 13> real_columns{{
    {"time_ms", [](HistoryLine& l) -> Real& { return l.time; }},
    {"dt_ms", [](HistoryLine& l) -> Real& { return l.dt; }},
    {"force_upper_N", [](HistoryLine& l) -> Real& { return l.force_upper; }},
    {"force_lower_N", [](HistoryLine& l) -> Real& { return l.force_lower; }},
    {"cod_mm", [](HistoryLine& l) -> Real& { return l.cod; }},
    {"kinetic_mJ", [](HistoryLine& l) -> Real& { return l.energy.kinetic; }},
    {"elastic_mJ", [](HistoryLine& l) -> Real& { return l.energy.elastic; }},
    {"plastic_mJ", [](HistoryLine& l) -> Real& { return l.energy.plastic; }},
    {"decohesion_mJ", [](HistoryLine& l) -> Real& { return l.energy.decohesion; }},
    {"damping_mJ", [](HistoryLine& l) -> Real& { return l.energy.damping; }},
    {"external_mJ", [](HistoryLine& l) -> Real& { return l.energy.external; }},
    {"initial_mJ", [](HistoryLine& l) -> Real& { return l.energy.initial; }},
    {"max_damage", [](HistoryLine& l) -> Real& { return l.max_damage; }},
}};
constexpr std::size_t fixed_columns = real_columns.size() + 3; // with step, residual_mJ and separated_particles

std::vector<std::string_view> split(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (std::size_t end = line.find(','); end != line.npos; end = line.find(',')) {
        cells.push_back(line.substr(0, end));
        line.remove_prefix(end + 1);
    }
    cells.push_back(line);
    return cells;
}

template <class T>
bool parse(std::string_view text, T& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string> history_texts(const std::vector<HistoryLine>& history)
{
    std::vector<std::string> lines;
    for (const HistoryLine& line : history) lines.push_back(history_text(line));
    return lines;
}

bool parse_line(std::string_view text, std::size_t levels, HistoryLine& line)
{
    const std::vector<std::string_view> cells = split(text);
    if (cells.size() != fixed_columns + levels) return false;
    Real residual = 0; // recomputed from the other energies
    bool good = parse(cells[0], line.step);
    for (std::size_t i = 0; i < real_columns.size(); ++i) {
        const std::size_t cell = i + 1 < real_columns.size() ? i + 1 : i + 2; // residual_mJ stands before max_damage
        good = good && parse(cells[cell], real_columns[i].value(line));
    }
    good = good && parse(cells[real_columns.size()], residual);
    good = good && parse(cells[real_columns.size() + 2], line.separated_particles);
    line.particles.resize(levels);
    for (std::size_t l = 0; l < levels; ++l) good = good && parse(cells[fixed_columns + l], line.particles[l]);
    return good;
}
} // namespace

std::string history_header(int levels)
{
    std::string text = "step";
    for (std::size_t i = 0; i + 1 < real_columns.size(); ++i) text += fmt::format(",{}", real_columns[i].name);
    text += ",residual_mJ,max_damage,separated_particles";
    for (int l = 0; l < levels; ++l) text += fmt::format(",particles_l{}", l);
    return text;
}

std::string history_text(const HistoryLine& line)
{
    HistoryLine values = line; // the columns name members of a line that can be written
    std::string text = fmt::format("{}", line.step);
    for (std::size_t i = 0; i + 1 < real_columns.size(); ++i)
        text += fmt::format(",{:.10g}", real_columns[i].value(values));
    text += fmt::format(",{:.10g},{:.10g},{}", line.energy.residual(), line.max_damage, line.separated_particles);
    if (!line.particles.empty()) text += fmt::format(",{}", fmt::join(line.particles, ","));
    return text;
}

std::vector<HistoryLine> read_history(const std::filesystem::path& path)
{
    const std::string text = read_file(path);
    const std::vector<std::string_view> lines = complete_lines(text);
    if (lines.empty()) return {};
    const std::size_t columns = split(lines[0]).size();
    const std::size_t levels = columns < fixed_columns ? 0 : columns - fixed_columns;
    if (lines[0] != history_header(static_cast<int>(levels)))
        throw core::FileError("cannot read '" + path.string() + "': line 1 is not the header of a history");
    std::vector<HistoryLine> history(lines.size() - 1);
    for (std::size_t i = 0; i < history.size(); ++i)
        if (!parse_line(lines[i + 1], levels, history[i]))
            throw core::FileError(fmt::format("cannot read '{}': line {} has not {} numbers", path.string(), i + 2,
                                              fixed_columns + levels));
    return history;
}

HistoryFile::HistoryFile(const std::filesystem::path& path, int levels, const std::vector<HistoryLine>& history)
    : file_(path, history_header(levels), history_texts(history))
{}

void HistoryFile::append(const HistoryLine& line)
{
    file_.append(history_text(line));
}
} // namespace io
