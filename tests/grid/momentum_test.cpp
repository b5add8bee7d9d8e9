#include "grid/momentum.h"

#include "tests/support/topologies.h"

#include <gtest/gtest.h>

TEST(Momentum, nodes_move_by_force_over_mass_and_gravity)
{
    grid::Levels levels = support::levels_of(support::topologies()[1]);
    for (grid::NodeSum& sum : levels.sum) sum = {2, {1, -2, 3}, {10, 20, -30}, 0};
    grid::advance_momentum({}, Vec3(0, 0, -9), {0, 0}, 0.1, levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
        EXPECT_DOUBLE_EQ(motion.change[0], 0.5);
        EXPECT_DOUBLE_EQ(motion.change[1], 1);
        EXPECT_DOUBLE_EQ(motion.change[2], -2.4);
        EXPECT_DOUBLE_EQ(motion.velocity[0], 1);
        EXPECT_DOUBLE_EQ(motion.velocity[2], 1.5 - 2.4);
    });
}

TEST(Momentum, nodes_lighter_than_the_cutoff_of_their_level_rest)
{
    grid::Levels levels = support::levels_of(support::topologies()[1]);
    for (grid::NodeSum& sum : levels.sum) sum = {2, {1, 1, 1}, {1, 1, 1}, 0};
    grid::advance_momentum({}, Vec3(1, 1, 1), {2.5, 1.5}, 0.1, levels);
    grid::remap_velocity({}, {1.5, 2.5}, levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        const bool coarse = levels.leaves[leaf].level == 0;
        EXPECT_EQ(levels.motions(leaf)[at.node].velocity[0] == 0, coarse);
        EXPECT_EQ(levels.motions(leaf)[at.node].change[0] == 0, !coarse); // holds the mapped velocity now
    });
}

// A wall is a plane of nodes of every level, wherever the leaves are cut.
TEST(Momentum, walls_stop_the_normal_component_on_their_plane_only)
{
    for (const support::Topology& topology : support::topologies())
        for (int axis = 0; axis < 3; ++axis)
            for (const int node0 : {-1, 0, 1}) {
                grid::Levels levels = support::levels_of(topology);
                for (grid::NodeSum& sum : levels.sum) sum = {1, {1, 1, 1}, {1, 1, 1}, 0};
                const std::vector<Real> no_cutoff(static_cast<std::size_t>(levels.count), 0);
                const std::vector<grid::WallPlane> walls{{axis, node0}};
                grid::advance_momentum(walls, Vec3::Zero(), no_cutoff, 1, levels);
                const Real plane = levels.origin[axis] + levels.spacing0 * node0;
                int on_plane = 0;
                support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
                    const grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
                    const bool stopped = std::abs(x[axis] - plane) < 1e-9;
                    on_plane += stopped ? 1 : 0;
                    for (int a = 0; a < 3; ++a) {
                        EXPECT_EQ(motion.velocity[static_cast<std::size_t>(a)], stopped && a == axis ? 0 : 2);
                        EXPECT_EQ(motion.change[static_cast<std::size_t>(a)], stopped && a == axis ? 0 : 1);
                    }
                });
                EXPECT_GT(on_plane, 0) << topology;
            }
}
