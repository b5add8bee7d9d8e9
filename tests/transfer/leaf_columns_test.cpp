/// transfer/leaf_columns.h against the tile it reads and writes, node by node.
#include "transfer/leaf_columns.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace
{
using transfer::block_lanes;
using transfer::BlockPart;
using transfer::CellBlock;
using transfer::part_lanes;
using transfer::PartLanes;

/// Cells of a leaf dealt to blocks as transfer/lattice.cpp does it.
template <class T>
std::vector<CellBlock<T>> blocks_of(const std::vector<int>& cells)
{
    std::vector<CellBlock<T>> blocks;
    for (const int cell : cells) {
        if (blocks.empty() || blocks.back().count == block_lanes<T>) blocks.emplace_back();
        blocks.back().add(cell, 0, 0xff);
    }
    return blocks;
}

/// A body with rows of eight, of three and of single cells, in the upper part of the leaf; nothing in the lowest corner
/// of the box about it.
std::vector<int> ragged_cells()
{
    std::vector<int> cells;
    for (int i = 2; i < 8; ++i)
        for (int j = 1; j < 8; ++j)
            for (int k = 0; k < 8; ++k)
                if (i == 2 ? j + k > 3 : i < 4 || (j < 4 ? k < 3 : (i + j + k) % 2 == 0))
                    cells.push_back(grid::cell_index(i, j, k));
    return cells;
}

grid::NodeBox box_of(const std::vector<int>& cells)
{
    grid::NodeBox box;
    for (const int cell : cells)
        for (std::size_t a = 0; a < 3; ++a) {
            const auto lower = static_cast<std::int8_t>(cell >> (6 - 3 * a) & 7);
            box.lower[a] = std::min(box.lower[a], lower);
            box.upper[a] = std::max(box.upper[a], static_cast<std::int8_t>(lower + 1));
        }
    return box;
}

template <class T, class Visit>
void for_parts(const std::vector<CellBlock<T>>& blocks, const Visit& visit)
{
    for (const CellBlock<T>& block : blocks)
        for (int first = 0; first < block.count; first += part_lanes<T>) visit(BlockPart<T>{block, first});
}

int corner_of(int node, int corner)
{
    return node + grid::tile_index(corner >> 2, corner >> 1 & 1, corner & 1);
}

template <class T>
class LeafColumns : public testing::Test
{};
using Numbers = testing::Types<Real, float>;
TYPED_TEST_SUITE(LeafColumns, Numbers);
} // namespace

TYPED_TEST(LeafColumns, a_cell_gets_the_motion_of_its_corners)
{
    using T = TypeParam;
    support::Random random(3);
    std::vector<grid::NodeMotion> tile(grid::tile_nodes);
    for (grid::NodeMotion& node : tile)
        for (std::size_t a = 0; a < 3; ++a) {
            node.velocity[a] = 1e6 + random.between(-1, 1);
            node.change[a] = -1e6 + random.between(-1, 1);
        }
    const std::vector<int> cells = ragged_cells();
    const grid::NodeBox box = box_of(cells);
    tile[static_cast<std::size_t>(grid::tile_index(box.lower[0], box.lower[1], box.lower[2]))] = {}; // does not move
    const auto blocks = blocks_of<T>(cells);
    const int node0 = blocks.front().node[0];
    const grid::NodeMotion& origin = tile[static_cast<std::size_t>(node0)];
    transfer::MotionColumns<T> columns;
    transfer::read_motion(tile.data(), box, node0, columns);
    std::size_t seen = 0;
    for_parts(blocks, [&](const BlockPart<T>& part) {
        PartLanes<T> velocity[3][8], displacement[3][8];
        gather_corners(columns, part, velocity, displacement);
        for (int i = 0; i < part_lanes<T>; ++i)
            for (int a = 0; a < 3; ++a)
                for (int c = 0; c < 8; ++c) {
                    const auto axis = static_cast<std::size_t>(a);
                    const bool cell = i < part.count();
                    const grid::NodeMotion& node =
                        cell ? tile[static_cast<std::size_t>(corner_of(part.node(i), c))] : origin;
                    EXPECT_EQ(velocity[a][c][i], static_cast<T>(node.velocity[axis] - origin.velocity[axis]));
                    EXPECT_EQ(displacement[a][c][i], static_cast<T>(node.change[axis] - origin.change[axis]));
                    seen += cell && a == 0 && c == 0 ? 1 : 0;
                }
    });
    EXPECT_EQ(seen, cells.size());
}

TYPED_TEST(LeafColumns, forces_of_cells_add_up_at_their_corners)
{
    using T = TypeParam;
    support::Random random(4);
    std::vector<std::array<Real, 3>> expected(grid::tile_nodes);
    std::vector<grid::NodeForce> tile(grid::tile_nodes);
    for (grid::NodeForce& node : tile) node = {{7, 7, 7}, random.between(1, 2)};
    const std::vector<grid::NodeForce> before = tile;
    const std::vector<int> cells = ragged_cells();
    const auto blocks = blocks_of<T>(cells);
    transfer::ForceColumns<T> columns;
    transfer::clear<T>(columns);
    for_parts(blocks, [&](const BlockPart<T>& part) {
        PartLanes<T> force[3][8];
        for (int a = 0; a < 3; ++a)
            for (int c = 0; c < 8; ++c)
                for (int i = 0; i < part_lanes<T>; ++i) {
                    const Real number = std::floor(random.between(-100, 100)); // sums without rounding
                    force[a][c].v[i] = static_cast<T>(number);
                    if (i < part.count())
                        expected[static_cast<std::size_t>(corner_of(part.node(i), c))][static_cast<std::size_t>(a)] +=
                            number;
                }
        scatter_corners(force, part, columns);
    });
    const grid::NodeBox box = box_of(cells);
    transfer::write_forces<T>(columns, box, tile.data());
    for (int i = box.lower[0]; i <= box.upper[0]; ++i)
        for (int j = box.lower[1]; j <= box.upper[1]; ++j)
            for (int k = 0; k <= grid::leaf_side; ++k) {
                const auto node = static_cast<std::size_t>(grid::tile_index(i, j, k));
                EXPECT_EQ(tile[node].force, expected[node]) << i << ' ' << j << ' ' << k;
                EXPECT_EQ(tile[node].per_mass, before[node].per_mass);
            }
    EXPECT_EQ(tile[0].force, before[0].force);
}
