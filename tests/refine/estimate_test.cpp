#include "refine/estimate.h"

#include <gtest/gtest.h>

namespace
{
const geometry::Shape plate = geometry::box(Vec3(0, 0, 0), Vec3(8, 8, 1));
} // namespace

TEST(Estimate, counts_the_particles_of_the_zones_and_of_the_rest)
{
    const std::vector<refine::Zone> zones{{"left", geometry::box(Vec3(-1, -1, -1), Vec3(3, 9, 2)), 1, 1},
                                          {"end", geometry::box(Vec3(-1, -1, -1), Vec3(2, 9, 2)), 2, 0}};
    const refine::Scene scene{{1, Vec3::Zero(), 3}, zones, {plate}, particles::EdgeTreatment::fraction, 2};
    const std::vector<Real> expected{4 * 8 * 8, 2 * 8 * 8 * 8, 2 * 8 * 8 * 64};
    EXPECT_EQ(refine::estimated_particles(scene), expected);
}

TEST(Estimate, adds_bodies_and_leaves_holes_out)
{
    const std::vector<refine::Zone> none;
    const geometry::Shape ring = geometry::subtract(geometry::box(Vec3(20, 0, 0), Vec3(28, 8, 1)),
                                                    {geometry::cylinder(Vec3(24, 4, -1), Vec3(24, 4, 2), 2)});
    const refine::Scene scene{{0.5, Vec3::Zero(), 1}, none, {plate, ring}, particles::EdgeTreatment::fraction, 3};
    const Real hole = 3.14159265 * 4;
    EXPECT_NEAR(refine::estimated_particles(scene).at(0), (64 + 64 - hole) * 8 * 27, 0.005 * 128 * 8 * 27);
}
