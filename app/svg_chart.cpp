#include "app/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app
{
namespace
{
constexpr double width = 860, height = 420;                     // px
constexpr double left = 78, right = 190, top = 16, bottom = 52; // px, margins of the plot
constexpr std::size_t most_points = 4000;                       // of a line; more cannot be seen

struct Range
{
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void include(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// A range to draw over: with zero, never empty.
Range drawn(Range range)
{
    range.include(0);
    if (range.low == range.high) range.high = range.low + 1;
    const double air = 0.04 * (range.high - range.low);
    if (range.low < 0) range.low -= air;
    range.high += air;
    return range;
}

struct Frame
{
    Range x, y;
    double px(double value) const { return left + (value - x.low) / (x.high - x.low) * (width - left - right); }
    double py(double value) const
    {
        return height - bottom - (value - y.low) / (y.high - y.low) * (height - top - bottom);
    }
};

bool drawable(const ChartSeries& series, std::size_t i)
{
    return std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
}

Frame frame_of(const Chart& chart)
{
    Range x, y;
    for (const ChartSeries& series : chart.series)
        for (std::size_t i = 0; i < series.x.size(); ++i)
            if (drawable(series, i)) {
                x.include(series.x[i]);
                y.include(series.y[i]);
            }
    return {drawn(x), drawn(y)};
}

std::string text(double x, double y, const char* anchor, const std::string& what, const char* more = "")
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                       escape_xml(what));
}

std::string axes(const Frame& frame, const Chart& chart)
{
    std::string svg = "<g stroke=\"#ddd\">\n", labels;
    for (const double tick : round_ticks(frame.x.low, frame.x.high, 8)) {
        svg += fmt::format("<path d=\"M{:.1f} {}V{}\"/>\n", frame.px(tick), top, height - bottom);
        labels += text(frame.px(tick), height - bottom + 18, "middle", fmt::format("{:.6g}", tick));
    }
    for (const double tick : round_ticks(frame.y.low, frame.y.high, 6)) {
        svg += fmt::format("<path d=\"M{} {:.1f}H{}\"/>\n", left, frame.py(tick), width - right);
        labels += text(left - 8, frame.py(tick) + 4, "end", fmt::format("{:.6g}", tick));
    }
    svg += "</g>\n" + labels;
    svg += text((left + width - right) / 2, height - 12, "middle", chart.x_label);
    const std::string turned = fmt::format(" transform=\"rotate(-90 16 {})\"", (top + height - bottom) / 2);
    svg += text(16, (top + height - bottom) / 2, "middle", chart.y_label, turned.c_str());
    return svg + fmt::format("<path d=\"M{} {}V{}H{}\" fill=\"none\" stroke=\"#333\"/>\n", left, top, height - bottom,
                             width - right);
}

std::string line(const Frame& frame, const ChartSeries& series)
{
    const std::size_t stride = 1 + series.x.size() / most_points;
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        const bool last = i + 1 == series.x.size();
        if (i % stride != 0 && !last) continue;
        if (drawable(series, i))
            path += fmt::format("{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', frame.px(series.x[i]), frame.py(series.y[i]));
        pen_down = drawable(series, i);
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path, series.colour);
}

std::string points(const Frame& frame, const ChartSeries& series)
{
    std::string svg;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!drawable(series, i)) continue;
        const double x = frame.px(series.x[i]), y = frame.py(series.y[i]);
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" fill-opacity=\"0.75\"/>\n", x, y,
                           series.colour);
        if (i < series.names.size()) svg += text(x + 8, y - 6, "start", series.names[i]);
    }
    return svg;
}

std::string legend(const Chart& chart)
{
    std::string svg;
    double y = top + 16;
    for (const ChartSeries& series : chart.series) {
        svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"14\" height=\"4\" fill=\"{}\"/>\n", width - right + 14,
                           y - 6, series.colour);
        svg += text(width - right + 34, y, "start", series.label);
        y += 18;
    }
    return svg;
}

/// What is inside the element of a chart.
std::string content(const Chart& chart)
{
    const Frame frame = frame_of(chart);
    std::string svg = axes(frame, chart);
    for (const ChartSeries& series : chart.series)
        svg += series.mark == ChartSeries::Mark::line ? line(frame, series) : points(frame, series);
    return svg + legend(chart);
}

std::string opening_tag(double total_height)
{
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"{}\" "
                       "font-family=\"sans-serif\" font-size=\"12\">\n",
                       width, total_height, width);
}
} // namespace

std::vector<double> round_ticks(double low, double high, int count)
{
    const double rough = (high - low) / count;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
    std::vector<double> ticks;
    for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
        ticks.push_back(i * step + 0.0); // + 0 makes -0 a 0
    return ticks;
}

std::string svg_chart(const Chart& chart)
{
    return opening_tag(height) + content(chart) + "</svg>\n";
}

std::string svg_charts(const std::vector<Chart>& charts)
{
    std::string svg = opening_tag(static_cast<double>(charts.size()) * height);
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (std::size_t i = 0; i < charts.size(); ++i)
        svg += fmt::format("<g transform=\"translate(0 {})\">\n{}</g>\n", static_cast<double>(i) * height,
                           content(charts[i]));
    return svg + "</svg>\n";
}

std::string escape_xml(const std::string& text)
{
    std::string escaped;
    for (const char c : text) {
        switch (c) {
        case '&':
            escaped += "&amp;";
            break;
        case '<':
            escaped += "&lt;";
            break;
        case '>':
            escaped += "&gt;";
            break;
        case '"':
            escaped += "&quot;";
            break;
        case '\'':
            escaped += "&#39;";
            break;
        default:
            escaped += c;
        }
    }
    return escaped;
}
} // namespace app
