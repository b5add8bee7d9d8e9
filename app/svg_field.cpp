#include "app/svg_field.h"

#include "app/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace app
{
namespace
{
constexpr int colours = 32;
constexpr int most_pixels = 800; // along the longer edge
constexpr int bar_space = 90;    // px, for the colour bar
constexpr float overlap = 1.2f;  // squares are drawn this much larger, so that stretched metal shows no gaps
constexpr std::uint8_t empty = 255;

/// Colour of a bin: five stops of the viridis map (Smith & van der Walt 2015), dark to bright.
std::string colour(int bin)
{
    constexpr std::array<std::array<double, 3>, 5> stops{
        {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
    const double place = 4.0 * bin / (colours - 1);
    const auto stop = std::min<std::size_t>(3, static_cast<std::size_t>(place));
    std::string text = "#";
    for (std::size_t c = 0; c < 3; ++c) {
        const double share = place - static_cast<double>(stop);
        text += fmt::format("{:02x}", std::lround(stops[stop][c] * (1 - share) + stops[stop + 1][c] * share));
    }
    return text;
}

struct Raster
{
    int width = 0, height = 0;          // px
    float pixel = 1, left = 0, top = 0; // mm
    std::vector<std::uint8_t> bin;      // [row][column], rows downwards
};

Raster empty_raster(const FieldPicture& picture)
{
    const auto [u0, u1] = std::minmax_element(picture.u.begin(), picture.u.end());
    const auto [v0, v1] = std::minmax_element(picture.v.begin(), picture.v.end());
    const float border = *std::max_element(picture.side.begin(), picture.side.end());
    const float wide = *u1 - *u0 + border, high = *v1 - *v0 + border;
    Raster raster;
    raster.pixel =
        std::max(*std::min_element(picture.side.begin(), picture.side.end()), std::max(wide, high) / most_pixels);
    raster.left = *u0 - border / 2;
    raster.top = *v1 + border / 2;
    raster.width = static_cast<int>(std::ceil(wide / raster.pixel));
    raster.height = static_cast<int>(std::ceil(high / raster.pixel));
    raster.bin.assign(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height), empty);
    return raster;
}

/// Colour the pixels whose centres the square of a particle covers.
void stamp(float u, float v, float side, std::uint8_t bin, Raster& raster)
{
    const float half = overlap * std::max(side, raster.pixel) / 2;
    const auto first = [&](float from) { return std::max(0, static_cast<int>(std::ceil(from / raster.pixel - 0.5f))); };
    const auto end = [&](float to, int limit) {
        return std::min(limit, static_cast<int>(std::floor(to / raster.pixel - 0.5f)) + 1);
    };
    const float x = u - raster.left, y = raster.top - v;
    for (int row = first(y - half); row < end(y + half, raster.height); ++row)
        for (int column = first(x - half); column < end(x + half, raster.width); ++column)
            raster.bin[static_cast<std::size_t>(row * raster.width + column)] = bin;
}

/// One path per colour, made of the horizontal runs of pixels.
std::string paths(const Raster& raster)
{
    std::vector<std::string> path(colours);
    for (int row = 0; row < raster.height; ++row) {
        const std::uint8_t* line = raster.bin.data() + static_cast<std::ptrdiff_t>(row) * raster.width;
        for (int start = 0, end = 0; start < raster.width; start = end) {
            while (end < raster.width && line[end] == line[start]) ++end;
            if (line[start] != empty)
                path[line[start]] += fmt::format("M{} {}h{}v1h-{}z", start, row, end - start, end - start);
        }
    }
    std::string svg;
    for (int bin = 0; bin < colours; ++bin)
        if (const std::string& d = path[static_cast<std::size_t>(bin)]; !d.empty())
            svg += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", colour(bin), d);
    return svg;
}

std::string colour_bar(double scale, double height, double low, double high, double x)
{
    std::string svg;
    const double step = height / colours;
    for (int bin = 0; bin < colours; ++bin)
        svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", x,
                           height - (bin + 1) * step, 14 * scale, 1.02 * step, colour(bin));
    for (const double tick : round_ticks(low, high, 5))
        svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{:.4g}</text>\n", x + 18 * scale,
                           height * (1 - (tick - low) / (high - low)) + 4 * scale, tick);
    return svg;
}
} // namespace

std::string svg_field(const FieldPicture& picture)
{
    if (picture.value.empty()) return {};
    const auto [least, most] = std::minmax_element(picture.value.begin(), picture.value.end());
    const double low = std::min(0.0f, *least), high = *most > low ? *most : low + 1;
    std::vector<std::size_t> order(picture.value.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return picture.value[a] < picture.value[b]; });
    Raster raster = empty_raster(picture);
    for (const std::size_t p : order) {
        const double share = (picture.value[p] - low) / (high - low);
        const int bin = std::clamp(static_cast<int>(share * colours), 0, colours - 1);
        stamp(picture.u[p], picture.v[p], picture.side[p], static_cast<std::uint8_t>(bin), raster);
    }
    const double wide = 560;                  // px, the field on the page
    const double scale = raster.width / wide; // pixels of the raster per px
    const double drawn = raster.width + bar_space * scale, title = 24 * scale;
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 {:.2f} {:.2f} {:.2f}\" "
                                  "width=\"{}\" font-family=\"sans-serif\" font-size=\"{:.3f}\">\n",
                                  -title, drawn, raster.height + 1.5 * title, wide + bar_space, 12 * scale);
    svg += fmt::format("<text x=\"0\" y=\"{:.2f}\">{}</text>\n", -8 * scale, escape_xml(picture.label));
    svg += "<g shape-rendering=\"crispEdges\">\n" + paths(raster) + "</g>\n";
    return svg + colour_bar(scale, raster.height, low, high, raster.width + 16 * scale) + "</svg>\n";
}
} // namespace app
