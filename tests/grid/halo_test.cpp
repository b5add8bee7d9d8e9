#include "grid/halo.h"

#include "grid/topology.h"
#include "tests/support/random.h"
#include "tests/support/topologies.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

namespace
{
using Key = std::tuple<int, int, int, int>; // level, node

Key key_of(const grid::Leaf& leaf, const Index3& local)
{
    const Index3 node = leaf.origin + local;
    return {leaf.level, node[0], node[1], node[2]};
}

/// `visit(leaf number, tile node, key)` for every corner of every leaf cell, in the tile of the cell's leaf; corners
/// shared by cells of one tile come once.
template <class Visit>
void for_each_tile_corner(const grid::Levels& levels, const Visit& visit)
{
    for (std::size_t n = 0; n < levels.leaves.size(); ++n) {
        std::vector<bool> seen(grid::tile_nodes, false);
        for (int c = 0; c < grid::leaf_cells; ++c) {
            if (levels.cell_active[n * grid::leaf_cells + static_cast<std::size_t>(c)] == 0) continue;
            for (int v = 0; v < 8; ++v) {
                const Index3 local = Index3(c / 64, c / 8 % 8, c % 8) + Index3(v >> 2, v >> 1 & 1, v & 1);
                const int node = grid::tile_index(local[0], local[1], local[2]);
                if (seen[static_cast<std::size_t>(node)]) continue;
                seen[static_cast<std::size_t>(node)] = true;
                visit(n, node, key_of(levels.leaves[n], local));
            }
        }
    }
}

/// The same corners at their owner.
template <class Visit>
void for_each_owned_corner(const grid::Levels& levels, const Visit& visit)
{
    for_each_tile_corner(levels, [&](std::size_t, int, const Key& key) {
        const auto [level, i, j, k] = key;
        const auto owner = static_cast<std::size_t>(grid::leaf_of(levels, level, Index3(i, j, k)));
        const Index3 local = Index3(i, j, k) - levels.leaves[owner].origin;
        visit(owner, grid::tile_index(local[0], local[1], local[2]), key);
    });
}
} // namespace

TEST(Halo, neighbours_are_the_leaves_eight_nodes_away)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels levels = support::levels_of(topology);
        ASSERT_FALSE(levels.leaves.empty());
        for (const grid::Leaf& leaf : levels.leaves)
            for (int n = 0; n < 27; ++n) {
                const Index3 wanted = leaf.origin + 8 * Index3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
                std::int32_t found = -1;
                for (std::size_t m = 0; m < levels.leaves.size(); ++m)
                    if (levels.leaves[m].level == leaf.level && levels.leaves[m].origin == wanted)
                        found = static_cast<std::int32_t>(m);
                EXPECT_EQ(leaf.neighbour[static_cast<std::size_t>(n)], found) << topology;
            }
    }
}

// Whole numbers add without rounding, so the sums must agree exactly whatever the order.
TEST(Halo, assembled_sums_are_those_of_a_map_over_all_tiles)
{
    for (const support::Topology& topology : support::topologies()) {
        grid::Levels levels = support::levels_of(topology);
        support::Random random(1);
        std::map<Key, Real> mass, momentum, force;
        for_each_tile_corner(levels, [&](std::size_t n, int node, const Key& key) {
            grid::NodeSum& sum = levels.sums(n)[node];
            sum.mass = random.whole(1, 1000);
            sum.momentum[1] = random.whole(-1000, 1000);
            sum.force[2] = random.whole(-1000, 1000);
            mass[key] += sum.mass;
            momentum[key] += sum.momentum[1];
            force[key] += sum.force[2];
        });
        grid::assemble_sums(levels);
        for_each_owned_corner(levels, [&](std::size_t n, int node, const Key& key) {
            EXPECT_EQ(levels.sums(n)[node].mass, mass[key]) << topology;
            EXPECT_EQ(levels.sums(n)[node].momentum[1], momentum[key]) << topology;
            EXPECT_EQ(levels.sums(n)[node].force[2], force[key]) << topology;
        });
    }
}

TEST(Halo, assembling_momentum_leaves_mass_and_force_alone)
{
    grid::Levels levels = support::levels_of(support::topologies().front());
    for (grid::NodeSum& sum : levels.sum) sum = {1, {1, 1, 1}, {1, 1, 1}, 0};
    grid::assemble_momentum(levels);
    Real largest = 0;
    for (const grid::NodeSum& sum : levels.sum) {
        EXPECT_EQ(sum.mass, 1);
        EXPECT_EQ(sum.force[0], 1);
        largest = std::max(largest, sum.momentum[0]);
    }
    EXPECT_EQ(largest, 8); // the node where eight leaves meet
}

TEST(Halo, every_corner_of_a_cell_sees_its_owners_motion)
{
    for (const support::Topology& topology : support::topologies()) {
        grid::Levels levels = support::levels_of(topology);
        Real number = 1;
        for_each_owned_corner(levels, [&](std::size_t n, int node, const Key&) {
            levels.motions(n)[node].velocity = {number, -number, 2 * number};
            levels.motions(n)[node].change[1] = 3 * number;
            number += 1;
        });
        std::map<Key, grid::NodeMotion> owned;
        for_each_owned_corner(levels,
                              [&](std::size_t n, int node, const Key& key) { owned[key] = levels.motions(n)[node]; });
        grid::fill_motion_halos(levels);
        for_each_tile_corner(levels, [&](std::size_t n, int node, const Key& key) {
            EXPECT_EQ(levels.motions(n)[node].velocity, owned[key].velocity) << topology;
            EXPECT_EQ(levels.motions(n)[node].change, owned[key].change) << topology;
        });
    }
}
