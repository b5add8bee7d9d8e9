#include "grid/refinement.h"

#include "tests/support/random.h"
#include "tests/support/topologies.h"

#include <gtest/gtest.h>

#include <cmath>

using grid::CellKey;

namespace
{
bool is_leaf(const grid::Refinement& refinement, const CellKey& key)
{
    if (key.level + 1 < refinement.levels() && refinement.subdivided(key.level, key.cell)) return false;
    for (int l = key.level - 1; l >= 0; --l) {
        const int shift = key.level - l;
        if (!refinement.subdivided(l, Index3(key.cell[0] >> shift, key.cell[1] >> shift, key.cell[2] >> shift)))
            return false;
    }
    return true;
}

/// Block with a few cells subdivided down to level 3, at random.
support::Topology random_topology(std::uint64_t seed)
{
    support::Random random(seed);
    return support::topology_of("random", 4, 3,
                                [&](const CellKey& key) { return key.level == 2 && random.whole(0, 2000) == 0; });
}
} // namespace

TEST(Refinement, neighbouring_leaf_cells_differ_by_at_most_one_level)
{
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const support::Topology topology = random_topology(seed);
        int deepest = 0;
        for (const CellKey& key : topology.cells) {
            deepest = std::max(deepest, key.level);
            const Real h = std::ldexp(1.0, -key.level);
            for (int n = 0; n < 27; ++n) {
                // Half a finest cell beyond each face, edge and corner.
                const Vec3 side(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
                const Vec3 beyond = h * (key.cell.cast<Real>() + Vec3::Constant(0.5)) + (h / 2 + 1.0 / 16) * side;
                if (beyond.cwiseAbs().maxCoeff() > 3) continue;
                EXPECT_LE(key.level - topology.refinement.locate(beyond).level, 1);
            }
        }
        EXPECT_EQ(deepest, 3);
    }
}

TEST(Refinement, balancing_twice_changes_nothing)
{
    const support::Topology topology = random_topology(4);
    grid::Refinement again = topology.refinement;
    std::vector<bool> before, after;
    const auto look = [&](std::vector<bool>& seen) {
        for (const CellKey& key : topology.cells) seen.push_back(is_leaf(again, key));
    };
    look(before);
    again.balance();
    look(after);
    EXPECT_EQ(before, after);
}

TEST(Refinement, locates_every_point_in_the_leaf_cell_that_contains_it)
{
    support::Random random(5);
    for (const support::Topology& topology : support::topologies())
        for (int n = 0; n < 200; ++n) {
            const Vec3 scaled = random.vector(-3.5, 3.5);
            const CellKey key = topology.refinement.locate(scaled);
            EXPECT_TRUE(is_leaf(topology.refinement, key)) << topology;
            const Vec3 local = scaled * std::ldexp(1.0, key.level) - key.cell.cast<Real>();
            EXPECT_GE(local.minCoeff(), 0) << topology;
            EXPECT_LT(local.maxCoeff(), 1) << topology;
        }
}

TEST(Refinement, a_point_on_a_lower_face_belongs_to_the_cell_above)
{
    grid::Refinement refinement(2);
    refinement.subdivide(0, Index3(-1, -1, -1));
    EXPECT_EQ(refinement.locate(Vec3(-1, -1, -1)).level, 1);
    EXPECT_EQ(refinement.locate(Vec3(-1, -1, -1)).cell, Index3(-2, -2, -2));
    EXPECT_EQ(refinement.locate(Vec3(-0.5, -0.25, -1)).cell, Index3(-1, -1, -2));
    EXPECT_EQ(refinement.locate(Vec3(0, -1, -1)).level, 0);
}

TEST(Refinement, a_copy_does_not_see_what_is_subdivided_afterwards)
{
    grid::Refinement refinement(2);
    const grid::Refinement copy = refinement;
    refinement.subdivide(0, Index3(1, 2, 3));
    EXPECT_TRUE(refinement.subdivided(0, Index3(1, 2, 3)));
    EXPECT_FALSE(copy.subdivided(0, Index3(1, 2, 3)));
}

TEST(Refinement, a_copy_does_not_see_what_is_balanced_afterwards)
{
    grid::Refinement refinement(3);
    refinement.subdivide(1, Index3(1, 0, 0)); // its neighbours of level 1 ask for (1, 0, 0) of level 0
    const grid::Refinement copy = refinement;
    refinement.balance();
    EXPECT_TRUE(refinement.subdivided(0, Index3(1, 0, 0)));
    EXPECT_FALSE(copy.subdivided(0, Index3(1, 0, 0)));
}

TEST(Refinement, subdividing_a_fine_cell_subdivides_what_contains_it)
{
    grid::Refinement refinement(3);
    refinement.subdivide(1, Index3(-3, 4, 5));
    EXPECT_TRUE(refinement.subdivided(0, Index3(-2, 2, 2)));
    EXPECT_FALSE(refinement.subdivided(0, Index3(-1, 2, 2)));
}
