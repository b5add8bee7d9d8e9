// Which cells a zone wants finer, and the particles that fill them.
#include "refine/populate.h"
#include "refine/zone.h"

#include <gtest/gtest.h>

#include <cmath>

using refine::Lattice;
using refine::Zone;

namespace
{
const Lattice lattice{0.5, Vec3(0.3, -0.7, 1.1), 3};
const geometry::Bounds block{lattice.origin, lattice.origin + Vec3::Constant(8 * 0.5 - 0.1)};

Vec3 in_cells(const Vec3& index)
{
    return lattice.origin + lattice.spacing0 * index;
}

Zone zone(const Vec3& lower, const Vec3& upper, int level, Real margin = 0)
{
    return {"zone", geometry::box(in_cells(lower), in_cells(upper)), level, margin};
}

/// Level of the leaf cell that holds a point given in level-0 cells.
int level_at(const grid::Refinement& refinement, const Vec3& index)
{
    return refinement.locate(index).level;
}
} // namespace

TEST(Zone, a_cell_gets_the_highest_level_of_the_zones_that_touch_it)
{
    const Zone wide = zone({2.1, 2.1, 2.1}, {3.9, 3.9, 3.9}, 1), narrow = zone({3.2, 3.2, 3.2}, {3.6, 3.6, 3.6}, 2);
    for (const std::vector<Zone>& zones : {std::vector<Zone>{wide, narrow}, std::vector<Zone>{narrow, wide}}) {
        const auto wanted = [&](const Vec3& cell) { return refine::wanted_level(zones, in_cells(cell), 0.5); };
        EXPECT_EQ(wanted({2, 2, 2}), 1);
        EXPECT_EQ(wanted({3, 3, 3}), 2); // holds the centre
        EXPECT_EQ(wanted({1, 2, 2}), 0);
        EXPECT_EQ(wanted({5, 5, 5}), 0);
    }
    EXPECT_EQ(refine::wanted_level({zone({2.9, 2, 2}, {4, 4, 4}, 1)}, in_cells({2, 2, 2}), 0.5), 1); // a corner only
}

TEST(Zone, a_margin_grows_the_zone)
{
    const auto wanted = [](Real margin) {
        return refine::wanted_level({zone({2, 2, 2}, {4, 4, 4}, 1, margin)}, in_cells({0.5, 2, 2}), 0.5);
    };
    EXPECT_EQ(wanted(0), 0);
    EXPECT_EQ(wanted(0.2), 0); // 0.25 mm away
    EXPECT_EQ(wanted(0.3), 1);
}

TEST(Zone, refinement_reaches_the_wanted_level_and_falls_off_one_level_at_a_time)
{
    const grid::Refinement refinement =
        refine::refinement_of({zone({4.1, 4.1, 4.1}, {4.6, 4.6, 4.6}, 2)}, lattice, block);
    EXPECT_EQ(level_at(refinement, {4.1, 4.1, 4.1}), 2);
    EXPECT_EQ(level_at(refinement, {4.9, 4.9, 4.9}), 2); // its level-1 cell has a corner in the zone
    // The zone is inside one level-0 cell: balance subdivides those around it, across faces, edges and corners.
    for (const Vec3& beyond : {Vec3(3.9, 4.1, 4.1), Vec3(3.9, 3.9, 3.9), Vec3(3.9, 3.9, 4.1)})
        EXPECT_EQ(level_at(refinement, beyond), 1) << beyond.transpose();
    EXPECT_EQ(level_at(refinement, {2.5, 4.1, 4.1}), 0);
    EXPECT_EQ(level_at(refinement, {6.5, 4.1, 4.1}), 0);
}

TEST(Zone, cells_of_every_level_are_filled_to_the_same_number)
{
    const grid::Refinement refinement =
        refine::refinement_of({zone({4.1, 4.1, 4.1}, {4.6, 4.6, 4.6}, 2)}, lattice, block);
    particles::Particles particles;
    refine::populate(geometry::box(in_cells({1, 1, 1}), in_cells({7, 7, 7})), {2, Vec3(1, 2, 3), 0, {}}, lattice,
                     refinement, 2, particles);
    Real volume = 0, mass = 0;
    std::array<std::size_t, 3> of_level{};
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 x(particles.position[0][p], particles.position[1][p], particles.position[2][p]);
        const int level = level_at(refinement, (x - lattice.origin) / lattice.spacing0);
        EXPECT_EQ(particles.size_level[p], level);
        EXPECT_EQ(particles.target_level[p], level);
        EXPECT_NEAR(particles.rest_volume[p], std::pow(0.5 / (1 << level), 3) / 8, 1e-15);
        EXPECT_EQ(particles.velocity[2][p], 3);
        volume += particles.rest_volume[p];
        mass += particles.mass[p];
        ++of_level[particles.size_level[p]];
    }
    EXPECT_NEAR(volume, 27, 1e-11);
    EXPECT_NEAR(mass, 54, 1e-11);
    for (const std::size_t count : of_level) EXPECT_GT(count, 0U);
}
