/// Lines of comma-separated values with quotes where they are needed (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace io
{
/// One line without its end.
std::string csv_line(const std::vector<std::string>& cells);

/// The lines of a text; cells may hold quoted commas, quotes and line ends.
std::vector<std::vector<std::string>> csv_cells(std::string_view text);
} // namespace io
