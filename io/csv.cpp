#include "io/csv.h"

#include <utility>

namespace io
{
std::string csv_line(const std::vector<std::string>& cells)
{
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) line += ',';
        if (cells[i].find_first_of(",\"\n\r") == std::string::npos) {
            line += cells[i];
            continue;
        }
        line += '"';
        for (const char c : cells[i]) line += c == '"' ? std::string("\"\"") : std::string(1, c);
        line += '"';
    }
    return line;
}

std::vector<std::vector<std::string>> csv_cells(std::string_view text)
{
    std::vector<std::vector<std::string>> lines;
    std::vector<std::string> line;
    std::string cell;
    bool quoted = false;
    const auto end_cell = [&] { line.push_back(std::exchange(cell, {})); };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
            cell += text[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            end_cell();
        else if (c == '\n' && !quoted) {
            end_cell();
            lines.push_back(std::exchange(line, {}));
        } else if (c != '\r' || quoted)
            cell += c;
    }
    if (!cell.empty() || !line.empty()) {
        end_cell();
        lines.push_back(line);
    }
    return lines;
}
} // namespace io
