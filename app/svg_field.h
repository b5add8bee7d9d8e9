/// A field on a plane section as SVG: particles drawn as squares of their size, coloured, with a colour bar.
#pragma once

#include <string>
#include <vector>

namespace app
{
/// Particles that the plane cuts; all columns have the same length.
struct FieldPicture
{
    std::string label;             // of the colour bar, with unit
    std::vector<float> u, v, side; // mm, place in the plane (v upwards) and edge
    std::vector<float> value;
};

/// The picture as an <svg> element; where particles overlap the largest value is seen. Empty text without particles.
std::string svg_field(const FieldPicture& picture);
} // namespace app
