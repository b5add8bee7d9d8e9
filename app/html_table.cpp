#include "app/html_table.h"

#include "app/svg_chart.h"

#include <fmt/format.h>

namespace app
{
std::string html_table(const TableRow& head, const std::vector<TableRow>& rows)
{
    const auto line = [](const TableRow& cells, const char* tag) {
        std::string html = "<tr>";
        for (const std::string& cell : cells) html += fmt::format("<{0}>{1}</{0}>", tag, escape_xml(cell));
        return html + "</tr>\n";
    };
    std::string html = "<table>\n" + (head.empty() ? "" : line(head, "th"));
    for (const TableRow& row : rows) html += line(row, "td");
    return html + "</table>\n";
}
} // namespace app
