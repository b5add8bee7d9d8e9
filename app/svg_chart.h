/// Line and point charts as SVG text, for reports: no program but a browser is needed to see them.
#pragma once

#include <string>
#include <vector>

namespace app
{
struct ChartSeries
{
    enum class Mark
    {
        line,
        points,
    };
    std::string label;
    std::string colour; // CSS
    Mark mark = Mark::line;
    std::vector<double> x, y;            // of equal length; pairs that are not finite are left out
    std::vector<std::string> names = {}; // of the points, may be empty
};

struct Chart
{
    std::string x_label, y_label; // with units
    std::vector<ChartSeries> series;
};

/// Positions of about `count` round numbers (1, 2 or 5 times a power of ten apart) inside [low, high].
/// @pre low < high
std::vector<double> round_ticks(double low, double high, int count);

/// The chart as an <svg> element: axes with ticks over the range of all series, a legend, the series in order.
std::string svg_chart(const Chart& chart);

/// Charts below each other as one <svg> element on white, for a file of its own.
std::string svg_charts(const std::vector<Chart>& charts);

/// Text with the five characters that mean something in XML replaced.
std::string escape_xml(const std::string& text);
} // namespace app
