// What shapes and zones will hold, before there is a mesh.
#include "refine/coverage.h"

#include <gtest/gtest.h>

using refine::Lattice;
using refine::Scene;
using refine::Zone;

namespace
{
const std::vector<Zone> no_zones;
const geometry::Shape plate = geometry::box(Vec3(0, 0, 0), Vec3(8, 8, 1));

Scene scene(const std::vector<Zone>& zones = no_zones, int levels = 1)
{
    return {Lattice{1, Vec3::Zero(), levels}, zones, {plate}};
}

geometry::Shape at(const Vec3& lower, const Vec3& upper)
{
    return geometry::box(lower, upper);
}
} // namespace

TEST(Coverage, a_body_needs_a_fiftieth_of_a_particle)
{
    EXPECT_TRUE(holds_particle(scene(), plate));
    EXPECT_TRUE(holds_particle(scene(), at({0, 0, 0}, {8, 8, 0.1})));
    // Between the sample points of a coarse cell, on those of a finer one.
    const geometry::Shape sheet = at({0, 0, 0}, {8, 8, 0.05});
    const std::vector<Zone> zones{{"edge", at({7, 7, -1}, {9, 9, 1}), 1, 0}};
    EXPECT_FALSE(holds_particle(scene(), sheet));
    EXPECT_TRUE(holds_particle(scene(zones, 2), sheet));
    EXPECT_FALSE(holds_particle(scene(), geometry::subtract(plate, {plate})));
}

TEST(Coverage, a_region_needs_a_node_beside_material)
{
    EXPECT_TRUE(holds_node(scene(), at({-1, -1, -1}, {9, 0.1, 2})));
    EXPECT_TRUE(holds_node(scene(), at({3, 3, 1}, {4, 4, 2}))) << "nodes on its face";
    EXPECT_FALSE(holds_node(scene(), at({-1, 3.1, -1}, {9, 3.9, 2}))) << "between nodes";
    EXPECT_FALSE(holds_node(scene(), at({3, 3, 1.5}, {4, 4, 3}))) << "beyond the cells with particles";
    EXPECT_TRUE(holds_node(scene(), geometry::Shape()));
}

// In cells of half the size, the nodes on the face of the coarse ones hang.
TEST(Coverage, a_node_that_hangs_cannot_be_held)
{
    const std::vector<Zone> zones{{"right", at({4.1, -1, -1}, {9, 9, 2}), 1, 0}};
    EXPECT_TRUE(holds_node(scene(zones, 2), at({-1, 3.4, -1}, {9, 3.6, 2})));
    EXPECT_FALSE(holds_node(scene(zones, 2), at({-1, 3.4, -1}, {4.1, 3.6, 2})));
}

TEST(Coverage, a_zone_between_corners_and_centres_refines_nothing)
{
    const auto refines_in = [](const Zone& zone) { return refines(scene(no_zones, 2), zone); };
    EXPECT_TRUE(refines_in({"centre", at({2.4, 2.4, 0.4}, {2.6, 2.6, 0.6}), 1, 0}));
    EXPECT_FALSE(refines_in({"between", at({2.1, 2.1, 0.1}, {2.4, 2.4, 0.4}), 1, 0}));
    EXPECT_TRUE(refines_in({"margin", at({2.1, 2.1, 0.1}, {2.4, 2.4, 0.4}), 1, 0.2}));
    EXPECT_FALSE(refines_in({"elsewhere", at({20, 2, 0}, {22, 4, 1}), 1, 0}));
}
