#include "geometry/shape.h"

#include "core/contract.h"
#include "geometry/primitives.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

namespace geometry
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

struct Union
{
    std::vector<Shape> parts;
    Real distance(const Vec3& point) const
    {
        Real nearest = infinity;
        for (const Shape& part : parts) nearest = std::min(nearest, part.distance(point));
        return nearest;
    }
    Bounds bounds() const
    {
        Bounds box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
        for (const Shape& part : parts) {
            const Bounds other = part.bounds();
            box.lower = box.lower.cwiseMin(other.lower);
            box.upper = box.upper.cwiseMax(other.upper);
        }
        return box;
    }
};

struct Intersection
{
    std::vector<Shape> parts;
    Real distance(const Vec3& point) const
    {
        Real farthest = -infinity;
        for (const Shape& part : parts) farthest = std::max(farthest, part.distance(point));
        return farthest;
    }
    Bounds bounds() const
    {
        Bounds box{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
        for (const Shape& part : parts) {
            const Bounds other = part.bounds();
            box.lower = box.lower.cwiseMax(other.lower);
            box.upper = box.upper.cwiseMin(other.upper);
        }
        return box;
    }
};

struct Difference
{
    Shape from;
    std::vector<Shape> holes;
    Real distance(const Vec3& point) const
    {
        Real farthest = from.distance(point);
        for (const Shape& hole : holes) farthest = std::max(farthest, -hole.distance(point));
        return farthest;
    }
    Bounds bounds() const { return from.bounds(); }
};

struct Grown
{
    Shape solid;
    Real margin; // mm
    Real distance(const Vec3& point) const { return solid.distance(point) - margin; }
    Bounds bounds() const
    {
        const Bounds box = solid.bounds();
        return {box.lower.array() - margin, box.upper.array() + margin};
    }
};

struct Extended
{
    Shape solid;
    int axis;
    Real at; // mm
    Real distance(Vec3 point) const
    {
        point[axis] = at;
        return solid.distance(point);
    }
    Bounds bounds() const
    {
        Bounds box = solid.bounds();
        box.lower[axis] = -infinity;
        box.upper[axis] = infinity;
        return box;
    }
};

using Solid =
    std::variant<Box, Sphere, Cylinder, HalfSpace, Prism, Tube, Union, Intersection, Difference, Grown, Extended>;
} // namespace

struct ShapeNode
{
    Solid solid;
};

namespace
{
Shape make(Solid solid)
{
    return Shape(std::make_shared<const ShapeNode>(ShapeNode{std::move(solid)}));
}
} // namespace

Shape::Shape() = default;
Shape::Shape(std::shared_ptr<const ShapeNode> node) : node_(std::move(node)) {}

Real Shape::distance(const Vec3& point) const
{
    if (!node_) return -infinity;
    return std::visit([&](const auto& solid) { return solid.distance(point); }, node_->solid);
}

Bounds Shape::bounds() const
{
    if (!node_) return {Vec3::Constant(-infinity), Vec3::Constant(infinity)};
    return std::visit([](const auto& solid) { return solid.bounds(); }, node_->solid);
}

Shape box(const Vec3& lower, const Vec3& upper)
{
    CLEAVE_EXPECTS((lower.array() < upper.array()).all());
    return make(Box{{lower, upper}});
}

Shape sphere(const Vec3& centre, Real radius)
{
    CLEAVE_EXPECTS(radius > 0);
    return make(Sphere{centre, radius});
}

Shape cylinder(const Vec3& from, const Vec3& to, Real radius)
{
    const Real length = (to - from).norm();
    CLEAVE_EXPECTS(radius > 0 && length > 0);
    return make(Cylinder{from, (to - from) / length, length, radius});
}

Shape half_space(const Vec3& point, const Vec3& outward_normal)
{
    CLEAVE_EXPECTS(outward_normal.norm() > 0);
    return make(HalfSpace{point, outward_normal.normalized()});
}

Shape extruded_polygon(const std::vector<std::array<Real, 2>>& corners, int axis, Real lower, Real upper)
{
    CLEAVE_EXPECTS(corners.size() >= 3 && axis >= 0 && axis < 3 && lower < upper);
    return make(Prism{corners, axis, lower, upper});
}

Shape tube(const std::vector<Vec3>& points, Real radius)
{
    CLEAVE_EXPECTS(!points.empty() && radius > 0);
    return make(Tube{points, radius});
}

Shape unite(std::vector<Shape> parts)
{
    CLEAVE_EXPECTS(!parts.empty());
    return make(Union{std::move(parts)});
}

Shape intersect(std::vector<Shape> parts)
{
    CLEAVE_EXPECTS(!parts.empty());
    return make(Intersection{std::move(parts)});
}

Shape subtract(Shape from, std::vector<Shape> holes)
{
    return make(Difference{std::move(from), std::move(holes)});
}

Shape grown(Shape shape, Real margin)
{
    CLEAVE_EXPECTS(margin >= 0);
    return make(Grown{std::move(shape), margin});
}

Shape extended(Shape shape, int axis, Real at)
{
    CLEAVE_EXPECTS(axis >= 0 && axis < 3);
    return make(Extended{std::move(shape), axis, at});
}
} // namespace geometry
