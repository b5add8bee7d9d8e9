#include "geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geometry
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

Real product_distance(Real a, Real b)
{
    return std::min(std::max(a, b), Real(0)) + std::hypot(std::max(a, Real(0)), std::max(b, Real(0)));
}

/// Signed distance [mm] of a point to a simple polygon: nearest edge, sign by crossing number.
Real polygon_distance(const std::vector<std::array<Real, 2>>& corners, Real x, Real y)
{
    Real nearest_squared = infinity;
    bool inside = false;
    for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
        const auto [xi, yi] = corners[i];
        const auto [xj, yj] = corners[j];
        const Real edge_x = xj - xi, edge_y = yj - yi;
        const Real from_x = x - xi, from_y = y - yi;
        const Real length_squared = edge_x * edge_x + edge_y * edge_y;
        const Real share =
            length_squared > 0 ? std::clamp((from_x * edge_x + from_y * edge_y) / length_squared, Real(0), Real(1)) : 0;
        const Real off_x = from_x - share * edge_x, off_y = from_y - share * edge_y;
        nearest_squared = std::min(nearest_squared, off_x * off_x + off_y * off_y);
        if ((yi > y) != (yj > y) && x < xi + (y - yi) * edge_x / edge_y) inside = !inside;
    }
    return inside ? -std::sqrt(nearest_squared) : std::sqrt(nearest_squared);
}
} // namespace

Real Box::distance(const Vec3& point) const
{
    const Vec3 outside = (extent.lower - point).cwiseMax(point - extent.upper);
    return std::min(outside.maxCoeff(), Real(0)) + outside.cwiseMax(Real(0)).norm();
}

Bounds Sphere::bounds() const
{
    return {centre.array() - radius, centre.array() + radius};
}

Real Cylinder::distance(const Vec3& point) const
{
    const Vec3 offset = point - from;
    const Real along = offset.dot(direction);
    const Real across = (offset - along * direction).norm();
    return product_distance(across - radius, std::max(-along, along - length));
}

Bounds Cylinder::bounds() const
{
    const Vec3 to = from + length * direction;
    const Vec3 reach = radius * (Real(1) - direction.array().square()).max(Real(0)).sqrt().matrix();
    return {from.cwiseMin(to) - reach, from.cwiseMax(to) + reach};
}

Bounds HalfSpace::bounds() const
{
    Bounds box{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
    for (int a = 0; a < 3; ++a) {
        if (normal[a] == 1) box.upper[a] = point[a];
        if (normal[a] == -1) box.lower[a] = point[a];
    }
    return box;
}

Real Prism::distance(const Vec3& point) const
{
    const Real section = polygon_distance(corners, point[(axis + 1) % 3], point[(axis + 2) % 3]);
    return product_distance(section, std::max(lower - point[axis], point[axis] - upper));
}

Bounds Prism::bounds() const
{
    Bounds box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
    for (const std::array<Real, 2>& corner : corners)
        for (int k = 0; k < 2; ++k) {
            const int a = (axis + 1 + k) % 3;
            box.lower[a] = std::min(box.lower[a], corner[static_cast<std::size_t>(k)]);
            box.upper[a] = std::max(box.upper[a], corner[static_cast<std::size_t>(k)]);
        }
    box.lower[axis] = lower;
    box.upper[axis] = upper;
    return box;
}

Real Tube::distance(const Vec3& point) const
{
    Real nearest_squared = (point - points.front()).squaredNorm();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec3 edge = points[i + 1] - points[i];
        const Real length_squared = edge.squaredNorm();
        if (length_squared == 0) continue;
        const Real share = std::clamp((point - points[i]).dot(edge) / length_squared, Real(0), Real(1));
        nearest_squared = std::min(nearest_squared, (point - points[i] - share * edge).squaredNorm());
    }
    return std::sqrt(nearest_squared) - radius;
}

Bounds Tube::bounds() const
{
    Bounds box{points.front(), points.front()};
    for (const Vec3& point : points) {
        box.lower = box.lower.cwiseMin(point);
        box.upper = box.upper.cwiseMax(point);
    }
    return {box.lower.array() - radius, box.upper.array() + radius};
}
} // namespace geometry
