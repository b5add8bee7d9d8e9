/// The page of a chart: every scene with its picture, its summary and its runs, as one HTML file that needs no other.
#pragma once

#include "io/chart_file.h"

#include <map>
#include <string>
#include <vector>

namespace app
{
/// @param titles    of the scenes, by name
/// @param pictures  of the scenes as <svg> text, by name; scenes without one get tables only
std::string chart_page(const std::string& title, const std::vector<io::ChartRow>& rows,
                       const std::map<std::string, std::string>& titles,
                       const std::map<std::string, std::string>& pictures);

/// The summaries of all scenes as a table for the terminal.
std::string chart_text(const std::vector<io::ChartRow>& rows);

/// The same as a Markdown table.
std::string chart_markdown(const std::vector<io::ChartRow>& rows);
} // namespace app
