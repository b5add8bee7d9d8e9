#include "particles/seed.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using particles::EdgeTreatment;
using particles::inside_fraction;

/// Part of the cube [0, 1]^3 inside a shape, by distances.
Real share_of_unit_cube(const geometry::Shape& shape)
{
    return inside_fraction(shape, Vec3(0.5, 0.5, 0.5), 0.5, EdgeTreatment::distance);
}

/// A slab of the size of a body.
geometry::Shape slab(Real lower, Real upper)
{
    return geometry::box(Vec3(lower, -5, -5), Vec3(upper, 5, 5));
}

constexpr Real seams[] = {0.1, 0.125, 0.3, 0.37, 0.9}; // mm, beside sample points and on one
} // namespace

/// A wall along an axis may stand anywhere in a sub-cell.
TEST(Seed, share_from_distances_is_exact_for_walls_along_an_axis)
{
    for (const Real at : {0.03, 0.11, 0.5, 0.87, 0.995}) EXPECT_NEAR(share_of_unit_cube(slab(-5, at)), at, 1e-12);
}

/// The distance of a union is zero where its parts touch, and there is no surface.
TEST(Seed, share_from_distances_is_whole_where_parts_of_a_body_meet)
{
    for (const Real at : seams)
        EXPECT_NEAR(share_of_unit_cube(geometry::unite({slab(-5, at), slab(at, 5)})), 1, 1e-12) << at;
}

/// Nor is there metal between holes that touch, or overlap by less than the sample points are apart.
TEST(Seed, share_from_distances_is_nothing_where_holes_meet)
{
    for (const Real at : seams)
        for (const Real overlap : {0.0, 0.1}) {
            const geometry::Shape holed =
                geometry::subtract(slab(-5, 5), {slab(-6, at + overlap / 2), slab(at - overlap / 2, 6)});
            EXPECT_NEAR(share_of_unit_cube(holed), 0, 1e-12) << at << " " << overlap;
        }
}

/// Where a hole touches a node plane, as the hole of a plate does on its symmetry planes: the row of sub-cells outside
/// the circle is thin there, and points miss it.
TEST(Seed, share_from_distances_keeps_the_area_beside_a_hole_that_touches_the_grid)
{
    const Real side = 1. / 16;
    const geometry::Shape sheet = geometry::subtract(geometry::box(Vec3(-2, -2, -2), Vec3(2, 2, 2)),
                                                     {geometry::cylinder(Vec3(0, 0, -9), Vec3(0, 0, 9), 1)});
    const auto area = [&](EdgeTreatment edge) {
        Real sum = 0;
        for (int i = 0; i < 4; ++i)
            sum += side * side * inside_fraction(sheet, side * Vec3(i + 0.5, 15.5, 0.5), side / 2, edge);
        return sum;
    };
    const Real x = 4 * side, exact = x - (x * std::sqrt(1 - x * x) + std::asin(x)) / 2;
    EXPECT_NEAR(area(EdgeTreatment::distance) / exact, 1, 0.02);
    EXPECT_LT(area(EdgeTreatment::fraction) / exact, 0.95);
}
