#include "geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

/// Every exact primitive once, with a bounded surface.
std::vector<std::pair<const char*, geometry::Shape>> exact_primitives()
{
    return {
        {"box", geometry::box(Vec3(-1, -2, -0.5), Vec3(2, 1, 0.5))},
        {"sphere", geometry::sphere(Vec3(0.5, 0, 0), 1.5)},
        {"cylinder", geometry::cylinder(Vec3(-1, -1, 0), Vec3(1, 1, 1), 0.7)},
        {"half space", geometry::half_space(Vec3(0.3, 0, 0), Vec3(1, 2, -1))},
        {"polygon", geometry::extruded_polygon({{-1, -1}, {2, -1}, {2, 1}, {0, 0}, {-1, 1}}, 1, -1, 0.5)},
        {"tube", geometry::tube({Vec3(-1, 0, 0), Vec3(1, 0.5, 0), Vec3(1, 0.5, 2)}, 0.6)},
        {"extended", geometry::extended(geometry::sphere(Vec3(0.2, 0.3, 5), 1), 2, 5)},
        {"grown sphere", geometry::grown(geometry::sphere(Vec3(0, 0, 0), 1), 0.25)},
    };
}

std::vector<Vec3> random_points(int count, Real reach)
{
    std::mt19937 engine(7);
    std::uniform_real_distribution<Real> along(-reach, reach);
    std::vector<Vec3> points;
    for (int n = 0; n < count; ++n) points.emplace_back(along(engine), along(engine), along(engine));
    return points;
}

Vec3 gradient(const geometry::Shape& shape, const Vec3& point)
{
    constexpr Real step = 1e-6;
    Vec3 out;
    for (int a = 0; a < 3; ++a)
        out[a] =
            (shape.distance(point + step * Vec3::Unit(a)) - shape.distance(point - step * Vec3::Unit(a))) / (2 * step);
    return out;
}

TEST(Shape, exact_distance_leads_to_the_surface)
{
    // Walking the distance along its gradient ends on the surface: true only for exact distances. Points where the
    // gradient is not defined (medial surfaces) show by a gradient that is not a unit vector.
    for (const auto& [name, shape] : exact_primitives()) {
        int tried = 0;
        for (const Vec3& point : random_points(400, 3)) {
            // Capsules of a tube overlap: inside it is a bound only.
            if (name == std::string("tube") && shape.contains(point)) continue;
            const Vec3 slope = gradient(shape, point);
            if (std::abs(slope.norm() - 1) > 1e-6) continue;
            ++tried;
            const Vec3 foot = point - shape.distance(point) * slope;
            EXPECT_NEAR(shape.distance(foot), 0, 1e-5) << name << " at " << point.transpose();
        }
        EXPECT_GT(tried, 250) << name;
    }
}

TEST(Shape, distance_changes_no_faster_than_the_point)
{
    const geometry::Shape cut = geometry::subtract(
        geometry::unite({geometry::box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), geometry::sphere(Vec3(1, 0, 0), 1)}),
        {geometry::sphere(Vec3(0, 0, 0), 0.5), geometry::cylinder(Vec3(0, -2, 0), Vec3(0, 2, 0), 0.3)});
    const std::vector<Vec3> points = random_points(300, 2.5);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        EXPECT_LE(std::abs(cut.distance(points[i]) - cut.distance(points[i + 1])),
                  (points[i] - points[i + 1]).norm() + 1e-12);
}

TEST(Shape, distance_of_known_points)
{
    const geometry::Shape box = geometry::box(Vec3(0, 0, 0), Vec3(2, 2, 2));
    EXPECT_DOUBLE_EQ(box.distance(Vec3(1, 1, 1.5)), -0.5);
    EXPECT_DOUBLE_EQ(box.distance(Vec3(5, 6, 1)), 5); // 3, 4 off a corner edge
    const geometry::Shape cylinder = geometry::cylinder(Vec3(0, 0, 0), Vec3(0, 0, 2), 1);
    EXPECT_DOUBLE_EQ(cylinder.distance(Vec3(4, 0, 6)), 5);
    EXPECT_DOUBLE_EQ(cylinder.distance(Vec3(0, 0, 1)), -1);
    const geometry::Shape polygon =
        geometry::extruded_polygon({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, 2, 0, 2);
    EXPECT_NEAR(polygon.distance(Vec3(2, 2, 1)), 1, 1e-14); // in the notch of an L
    EXPECT_NEAR(polygon.distance(Vec3(0.5, 0.75, 1)), -0.5, 1e-14);
}

TEST(Shape, polygon_corners_follow_the_cyclic_order_of_the_axes)
{
    // Normal y: corners are (z, x).
    const geometry::Shape flat = geometry::extruded_polygon({{0, 0}, {1, 0}, {1, 5}, {0, 5}}, 1, -1, 1);
    EXPECT_TRUE(flat.contains(Vec3(4, 0, 0.5)));
    EXPECT_FALSE(flat.contains(Vec3(0.5, 0, 4)));
}

TEST(Shape, set_operations_have_the_sign_of_the_sets)
{
    const geometry::Shape a = geometry::box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), b = geometry::sphere(Vec3(1, 0, 0), 1);
    const geometry::Shape both = geometry::intersect({a, b}), any = geometry::unite({a, b});
    const geometry::Shape rest = geometry::subtract(a, {b});
    for (const Vec3& point : random_points(500, 2.2)) {
        EXPECT_EQ(any.contains(point), a.contains(point) || b.contains(point));
        EXPECT_EQ(both.contains(point), a.contains(point) && b.contains(point));
        EXPECT_EQ(rest.contains(point), a.contains(point) && !b.contains(point));
    }
}

TEST(Shape, bounds_hold_the_solid)
{
    for (const auto& [name, shape] : exact_primitives()) {
        const geometry::Bounds bounds = shape.bounds();
        for (const Vec3& point : random_points(2000, 3))
            if (shape.contains(point)) {
                EXPECT_TRUE((point.array() >= bounds.lower.array()).all()) << name;
                EXPECT_TRUE((point.array() <= bounds.upper.array()).all()) << name;
            }
    }
}

TEST(Shape, bounds_of_a_tilted_cylinder_are_tight)
{
    const geometry::Bounds bounds = geometry::cylinder(Vec3(0, 0, 0), Vec3(3, 4, 0), 1).bounds();
    EXPECT_NEAR(bounds.lower[0], -0.8, 1e-12);
    EXPECT_NEAR(bounds.upper[1], 4.6, 1e-12);
    EXPECT_NEAR(bounds.upper[2], 1, 1e-12);
}

TEST(Shape, unbounded_solids_have_infinite_bounds)
{
    const geometry::Shape hole = geometry::extended(geometry::sphere(Vec3(1, 2, 0), 0.5), 2, 0);
    EXPECT_EQ(hole.bounds().upper[2], infinity);
    EXPECT_DOUBLE_EQ(hole.bounds().upper[0], 1.5);
    EXPECT_DOUBLE_EQ(hole.distance(Vec3(1, 2, 1e6)), -0.5);
    EXPECT_EQ(geometry::Shape().distance(Vec3::Zero()), -infinity);
    EXPECT_EQ(geometry::half_space(Vec3(3, 0, 0), Vec3(1, 0, 0)).bounds().upper[0], 3);
    const geometry::Shape prism = geometry::extruded_polygon({{0, 0}, {1, 0}, {0, 1}}, 2, -infinity, infinity);
    EXPECT_LT(prism.distance(Vec3(0.2, 0.2, -1e9)), 0);
    const geometry::Shape slab = geometry::box(Vec3(-infinity, 0, -infinity), Vec3(infinity, 1, infinity));
    EXPECT_DOUBLE_EQ(slab.distance(Vec3(100, 3, -5)), 2);
    EXPECT_DOUBLE_EQ(slab.distance(Vec3(100, 0.25, -5)), -0.25);
}
} // namespace
