/// Signed-distance solids: primitives and CSG. Negative inside, zero on the surface, units mm.
///
/// A Shape is an immutable value, cheap to copy. Unions and intersections of exact distances are lower bounds of the
/// true distance outside (inside) the solid: the sign is exact everywhere, which is what seeding and zones need.
#pragma once

#include "core/real.h"

#include <array>
#include <memory>
#include <vector>

namespace geometry
{
/// Axis-aligned box.
struct Bounds
{
    Vec3 lower = Vec3::Zero();
    Vec3 upper = Vec3::Zero();
};

/// One node of the CSG tree; the closed list of kinds is in shape.cpp.
struct ShapeNode;

class Shape
{
public:
    /// Everything: distance -infinity, infinite bounds.
    Shape();
    explicit Shape(std::shared_ptr<const ShapeNode> node);

    /// Signed distance [mm] of a point [mm].
    Real distance(const Vec3& point) const;
    bool contains(const Vec3& point) const { return distance(point) < 0; }
    /// A box that holds the solid; entries are infinite where the solid is unbounded.
    Bounds bounds() const;

private:
    std::shared_ptr<const ShapeNode> node_;
};

Shape box(const Vec3& lower, const Vec3& upper);
Shape sphere(const Vec3& centre, Real radius);
/// Finite cylinder between two points of its axis.
Shape cylinder(const Vec3& from, const Vec3& to, Real radius);
/// The points x with (x - point) . normal < 0.
Shape half_space(const Vec3& point, const Vec3& outward_normal);
/// Polygon in the plane normal to `axis` (0 x, 1 y, 2 z), corners in the cyclic order of the other two axes
/// (axis z: x, y), extruded over [lower, upper] along the axis.
Shape extruded_polygon(const std::vector<std::array<Real, 2>>& corners, int axis, Real lower, Real upper);
/// All points within `radius` of a polyline: a chain of capsules.
Shape tube(const std::vector<Vec3>& points, Real radius);
Shape unite(std::vector<Shape> parts);
Shape intersect(std::vector<Shape> parts);
/// `from` without every one of `holes`.
Shape subtract(Shape from, std::vector<Shape> holes);
/// The solid grown by `margin` (>= 0).
Shape grown(Shape shape, Real margin);
/// The section of the solid with the plane x[axis] = at, extended without bound along the axis: through holes.
Shape extended(Shape shape, int axis, Real at);
} // namespace geometry
