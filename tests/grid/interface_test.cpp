#include "grid/interface.h"

#include "grid/topology.h"
#include "tests/support/random.h"
#include "tests/support/topologies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace
{
using Cell = std::tuple<int, int, int, int>;

template <class Visit>
void for_each_row(const grid::Levels& levels, const Visit& visit)
{
    for (const grid::LevelInterface& face : levels.interface)
        for (std::size_t s = 0; s < face.slave.size(); ++s) visit(face, s);
}

const grid::NodeSum& sum_at(const grid::Levels& levels, const grid::NodeAddress& at)
{
    return levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
}

/// Leaves, active cells, slaves and masters of two grids agree.
void expect_same_grid(const grid::Levels& a, const grid::Levels& b)
{
    ASSERT_EQ(a.leaves.size(), b.leaves.size());
    for (std::size_t n = 0; n < b.leaves.size(); ++n) {
        EXPECT_EQ(a.leaves[n].origin, b.leaves[n].origin);
        EXPECT_EQ(a.leaves[n].neighbour, b.leaves[n].neighbour);
    }
    EXPECT_EQ(a.cell_active, b.cell_active);
    EXPECT_EQ(a.constrained, b.constrained);
    const auto same = [](const grid::NodeAddress& left, const grid::NodeAddress& right) {
        return left.leaf == right.leaf && left.node == right.node;
    };
    for (std::size_t l = 0; l < b.interface.size(); ++l) {
        const grid::LevelInterface &f = a.interface[l], &g = b.interface[l];
        EXPECT_TRUE(std::equal(f.slave.begin(), f.slave.end(), g.slave.begin(), g.slave.end(), same));
        EXPECT_TRUE(
            std::equal(f.row_master.begin(), f.row_master.end(), g.row_master.begin(), g.row_master.end(), same));
        EXPECT_EQ(f.row_weight, g.row_weight);
        EXPECT_EQ(f.column_slave, g.column_slave);
        EXPECT_EQ(f.column_weight, g.column_weight);
        EXPECT_EQ(f.column_offset, g.column_offset);
        EXPECT_EQ(f.hanging.slot, g.hanging.slot);
        EXPECT_EQ(f.hanging.slave, g.hanging.slave);
        EXPECT_EQ(f.hanging.around, g.hanging.around);
    }
}
} // namespace

TEST(Interface, slaves_are_the_fine_corners_that_touch_a_coarser_cell)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels levels = support::levels_of(topology);
        std::set<Cell> cells;
        for (const grid::CellKey& key : topology.cells)
            cells.insert({key.level, key.cell[0], key.cell[1], key.cell[2]});
        std::size_t slaves = 0;
        for (std::size_t n = 0; n < levels.leaves.size(); ++n)
            for (int place = 0; place < grid::leaf_cells; ++place) {
                const grid::Leaf& leaf = levels.leaves[n];
                const Index3 local(place / 64, place / 8 % 8, place % 8);
                bool fine = false, coarse = false;
                for (int c = 0; c < 8; ++c) {
                    const Index3 cell = leaf.origin + local - Index3(c >> 2, c >> 1 & 1, c & 1);
                    fine = fine || cells.count({leaf.level, cell[0], cell[1], cell[2]}) > 0;
                    coarse = coarse || cells.count({leaf.level - 1, cell[0] >> 1, cell[1] >> 1, cell[2] >> 1}) > 0;
                }
                const int node = grid::tile_index(local[0], local[1], local[2]);
                EXPECT_EQ(levels.constrained[n * grid::tile_nodes + static_cast<std::size_t>(node)] != 0,
                          fine && coarse)
                    << topology;
                slaves += fine && coarse ? 1 : 0;
            }
        std::size_t rows = 0;
        for (const grid::LevelInterface& face : levels.interface) rows += face.slave.size();
        EXPECT_EQ(rows, slaves) << topology;
    }
}

// A master is never a slave itself: strong balance keeps a layer of cells between two interfaces.
TEST(Interface, rows_reproduce_constants_and_positions_from_free_masters_that_exist)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels levels = support::levels_of(topology);
        for_each_row(levels, [&](const grid::LevelInterface& face, std::size_t s) {
            Real weights = 0;
            Vec3 position = Vec3::Zero();
            for (int e = face.row_start[s]; e < face.row_start[s + 1]; ++e) {
                const auto entry = static_cast<std::size_t>(e);
                ASSERT_GE(face.row_master[entry].leaf, 0) << topology;
                EXPECT_EQ(levels.constrained[static_cast<std::size_t>(face.row_master[entry].leaf) * grid::tile_nodes +
                                             static_cast<std::size_t>(face.row_master[entry].node)],
                          0)
                    << topology;
                weights += face.row_weight[entry];
                position += face.row_weight[entry] * support::position_of(levels, face.row_master[entry]);
            }
            EXPECT_EQ(weights, 1) << topology;
            EXPECT_LT((position - support::position_of(levels, face.slave[s])).norm(), 1e-15) << topology;
        });
    }
}

TEST(Interface, every_kind_of_row_occurs)
{
    std::set<int> lengths;
    for (const support::Topology& topology : support::topologies())
        for_each_row(support::levels_of(topology), [&](const grid::LevelInterface& face, std::size_t s) {
            lengths.insert(face.row_start[s + 1] - face.row_start[s]);
        });
    EXPECT_EQ(lengths, (std::set<int>{1, 2, 4}));
}

TEST(Interface, rows_and_columns_know_how_far_the_masters_are)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels levels = support::levels_of(topology);
        for (std::size_t l = 0; l < levels.interface.size(); ++l) {
            const grid::LevelInterface& face = levels.interface[l];
            const Real spacing = levels.spacing(static_cast<int>(l) + 1);
            const auto expect = [&](const grid::NodeAddress& master, std::int32_t slave,
                                    const grid::MasterOffset& offset) {
                const Vec3 apart = support::position_of(levels, master) -
                                   support::position_of(levels, face.slave[static_cast<std::size_t>(slave)]);
                EXPECT_LT((apart - spacing * Vec3(offset[0], offset[1], offset[2])).norm(), 1e-14) << topology;
            };
            for (std::size_t s = 0; s < face.slave.size(); ++s)
                for (auto e = static_cast<std::size_t>(face.row_start[s]);
                     e < static_cast<std::size_t>(face.row_start[s + 1]); ++e)
                    expect(face.row_master[e], static_cast<std::int32_t>(s), face.row_offset[e]);
            for (std::size_t m = 0; m < face.master.size(); ++m)
                for (auto e = static_cast<std::size_t>(face.column_start[m]);
                     e < static_cast<std::size_t>(face.column_start[m + 1]); ++e)
                    expect(face.master[m], face.column_slave[e], face.column_offset[e]);
        }
    }
}

// Every corner of every active cell is looked at: those that are slaves off their masters hang, no other does.
TEST(Interface, hanging_cells_are_the_active_cells_with_a_slave_between_masters)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels levels = support::levels_of(topology);
        std::map<std::tuple<int, int, int, int>, std::int32_t> hanging; // node -> slave
        for (std::size_t l = 0; l < levels.interface.size(); ++l) {
            const grid::LevelInterface& face = levels.interface[l];
            for (std::size_t s = 0; s < face.slave.size(); ++s) {
                if (face.row_start[s + 1] - face.row_start[s] == 1) continue;
                const Vec3 at = (support::position_of(levels, face.slave[s]) - levels.origin) /
                                levels.spacing(static_cast<int>(l) + 1);
                hanging[{static_cast<int>(l), static_cast<int>(std::lround(at[0])),
                         static_cast<int>(std::lround(at[1])), static_cast<int>(std::lround(at[2]))}] =
                    static_cast<std::int32_t>(s);
            }
        }
        std::vector<std::size_t> found(levels.interface.size(), 0);
        for (const grid::CellKey& key : topology.cells) {
            if (key.level == 0) continue;
            const auto l = static_cast<std::size_t>(key.level - 1);
            const grid::HangingCells& cells = levels.interface[l].hanging;
            std::array<std::int32_t, 8> expected{};
            for (int c = 0; c < 8; ++c) {
                const Index3 node = key.cell + Index3(c >> 2, c >> 1 & 1, c & 1);
                const auto slave = hanging.find({static_cast<int>(l), node[0], node[1], node[2]});
                expected[static_cast<std::size_t>(c)] = slave == hanging.end() ? -1 : slave->second;
            }
            const auto slot = static_cast<std::size_t>(grid::active_slot(levels, key.level, key.cell));
            const auto at = std::lower_bound(cells.slot.begin(), cells.slot.end(), slot);
            const bool listed = at != cells.slot.end() && *at == slot;
            ASSERT_EQ(listed, *std::max_element(expected.begin(), expected.end()) >= 0) << topology;
            if (!listed) continue;
            const auto place = static_cast<std::size_t>(at - cells.slot.begin());
            EXPECT_EQ(cells.slave[place], expected) << topology;
            for (std::size_t c = 0; c < 8; ++c)
                if (expected[c] >= 0) {
                    EXPECT_EQ(cells.around[static_cast<std::size_t>(expected[c])][c], static_cast<int>(place));
                }
            ++found[l];
        }
        for (std::size_t l = 0; l < found.size(); ++l)
            EXPECT_EQ(found[l], levels.interface[l].hanging.slot.size()) << topology;
    }
}

// methods.md A.4, 8: <P^T f, v> = <f, P v>.
TEST(Interface, restriction_is_the_transpose_of_prolongation)
{
    for (const support::Topology& topology : support::topologies()) {
        grid::Levels levels = support::levels_of(topology);
        support::Random random(7);
        std::vector<Real> force;
        for (grid::NodeSum& sum : levels.sum) force.push_back(sum.force[0] = random.between(-1, 1));
        support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
            levels.motions(static_cast<std::size_t>(at.leaf))[at.node].velocity[0] = random.between(-1, 1);
        });
        grid::prolong_motion(levels);
        grid::restrict_sums(levels);
        Real before = 0, after = 0;
        std::vector<grid::NodeAddress> nodes;
        support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) { nodes.push_back(at); });
        const auto power = [&](const grid::NodeAddress& at, Real f) {
            return f * levels.motions(static_cast<std::size_t>(at.leaf))[at.node].velocity[0];
        };
        const auto index = [](const grid::NodeAddress& at) {
            return static_cast<std::size_t>(at.leaf) * grid::tile_nodes + static_cast<std::size_t>(at.node);
        };
        for (const grid::NodeAddress& at : nodes) {
            before += power(at, force[index(at)]);
            after += power(at, sum_at(levels, at).force[0]);
        }
        for_each_row(levels, [&](const grid::LevelInterface& face, std::size_t s) {
            before += power(face.slave[s], force[index(face.slave[s])]);
            EXPECT_EQ(sum_at(levels, face.slave[s]).force[0], 0) << topology;
        });
        EXPECT_NEAR(before, after, 1e-12 * static_cast<Real>(nodes.size())) << topology;
    }
}

TEST(Interface, prolongation_reproduces_linear_fields)
{
    for (const support::Topology& topology : support::topologies()) {
        grid::Levels levels = support::levels_of(topology);
        const auto field = [](const Vec3& x) { return 0.3 + 2 * x[0] - 5 * x[1] + 7 * x[2]; };
        support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
            levels.motions(static_cast<std::size_t>(at.leaf))[at.node].velocity[0] = field(x);
            levels.motions(static_cast<std::size_t>(at.leaf))[at.node].change[2] = -field(x);
        });
        grid::prolong_motion(levels);
        for_each_row(levels, [&](const grid::LevelInterface& face, std::size_t s) {
            const grid::NodeMotion& motion =
                levels.motions(static_cast<std::size_t>(face.slave[s].leaf))[face.slave[s].node];
            const Real expected = field(support::position_of(levels, face.slave[s]));
            EXPECT_NEAR(motion.velocity[0], expected, 1e-13) << topology;
            EXPECT_NEAR(motion.change[2], -expected, 1e-13) << topology;
        });
    }
}

TEST(Interface, a_restart_rebuilds_the_same_leaves_and_rows)
{
    for (const support::Topology& topology : support::topologies()) {
        const grid::Levels built = support::levels_of(topology);
        grid::Levels restored;
        restored.spacing0 = built.spacing0;
        restored.count = built.count;
        restored.origin = built.origin;
        restored.level_start = built.level_start;
        restored.cell_active = built.cell_active;
        for (const grid::Leaf& leaf : built.leaves) restored.leaves.push_back({leaf.level, leaf.origin, {}});
        // As after reading a file: the mask trees are gone.
        grid::restore(restored);
        ASSERT_EQ(restored.leaves.size(), built.leaves.size()) << topology;
        expect_same_grid(restored, built);
        const grid::Refinement refinement = grid::refinement_of_cells(restored);
        for (const grid::CellKey& key : topology.cells) {
            const Real h = 1 / static_cast<Real>(1 << key.level);
            const grid::CellKey found = refinement.locate(h * (key.cell.cast<Real>() + Vec3::Constant(0.5)));
            EXPECT_EQ(found.level, key.level) << topology;
            EXPECT_EQ(found.cell, key.cell) << topology;
        }
    }
}

TEST(Interface, a_cell_made_active_leaves_the_grid_that_would_be_built_with_it)
{
    for (const support::Topology& topology : support::topologies()) {
        support::Random random(11);
        std::vector<grid::CellKey> kept, dropped;
        for (const grid::CellKey& key : topology.cells) (random.between(0, 1) < 0.8 ? kept : dropped).push_back(key);
        grid::Levels levels = support::levels_of({topology.name, topology.refinement, kept});
        std::size_t made = 0;
        for (const grid::CellKey& key : dropped) {
            if (grid::activate(key, levels) < 0) continue;
            ++made;
            kept.push_back(key);
            expect_same_grid(levels, support::levels_of({topology.name, topology.refinement, kept}));
            ASSERT_FALSE(HasFailure()) << topology << ", cell " << key.cell.transpose() << " of level " << key.level;
        }
        EXPECT_GT(made, 0U) << topology;
        const grid::CellKey beyond{0, Index3(40, 0, 0)}; // no leaf there
        EXPECT_LT(grid::activate(beyond, levels), 0);
    }
}
