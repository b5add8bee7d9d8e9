/// Tables of the HTML pages.
#pragma once

#include <string>
#include <vector>

namespace app
{
using TableRow = std::vector<std::string>;

/// Text cells, escaped; no head if it is empty.
std::string html_table(const TableRow& head, const std::vector<TableRow>& rows);
} // namespace app
