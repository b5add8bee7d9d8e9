/// Exact signed distances of the primitive solids behind geometry/shape.h (negative inside, mm).
///
/// Each primitive is a plain struct with `distance` and `bounds`; infinite extents of Box and Prism are allowed.
/// Source of the composition rule for extruded sections: the distance to a product of two sets is
/// min(max(a, b), 0) + |(max(a, 0), max(b, 0))| with a, b the distances to the factors.
#pragma once

#include "core/real.h"
#include "geometry/shape.h"

#include <array>
#include <vector>

namespace geometry
{
struct Box
{
    Bounds extent;
    Real distance(const Vec3& point) const;
    Bounds bounds() const { return extent; }
};

struct Sphere
{
    Vec3 centre;
    Real radius; // mm
    Real distance(const Vec3& point) const { return (point - centre).norm() - radius; }
    Bounds bounds() const;
};

struct Cylinder
{
    Vec3 from;
    Vec3 direction; // 1, unit vector along the axis
    Real length;    // mm
    Real radius;    // mm
    Real distance(const Vec3& point) const;
    Bounds bounds() const;
};

struct HalfSpace
{
    Vec3 point;
    Vec3 normal; // 1, unit, outward
    Real distance(const Vec3& at) const { return (at - point).dot(normal); }
    Bounds bounds() const;
};

/// Polygon extruded along a coordinate axis; corners in the cyclic order of the other two axes.
struct Prism
{
    std::vector<std::array<Real, 2>> corners; // mm
    int axis;
    Real lower, upper; // mm
    Real distance(const Vec3& point) const;
    Bounds bounds() const;
};

/// A chain of capsules; exact outside, inside a lower bound where capsules overlap.
struct Tube
{
    std::vector<Vec3> points; // mm
    Real radius;              // mm
    Real distance(const Vec3& point) const;
    Bounds bounds() const;
};
} // namespace geometry
