#include "particles/seed.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using particles::EdgeTreatment;
using particles::inside_fraction;
} // namespace

/// A wall along an axis may stand anywhere in a sub-cell.
TEST(Seed, share_from_distances_is_exact_for_walls_along_an_axis)
{
    for (const Real at : {0.03, 0.11, 0.5, 0.87, 0.995}) {
        const geometry::Shape block = geometry::box(Vec3(-5, -5, -5), Vec3(at, 5, 5));
        EXPECT_NEAR(inside_fraction(block, Vec3(0.5, 0.5, 0.5), 0.5, EdgeTreatment::distance), at, 1e-12);
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
