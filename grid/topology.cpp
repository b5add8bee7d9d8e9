/// Leaves come from OpenVDB mask trees: `cells` marks C_l, `blocks` holds a tree leaf for every 8^3 block with a node
/// that some cell of C_l has as a corner; the running leaf number sits in the tree leaf's transient data.
#include "grid/topology.h"

#include "core/huge_pages.h"
#include "grid/interface.h"
#include "grid/shared_nodes.h"

#include <algorithm>
#include <openvdb/openvdb.h>
#include <tuple>

namespace grid
{
struct Topology
{
    std::vector<openvdb::MaskTree> cells;
    std::vector<openvdb::MaskTree> blocks;
};

namespace
{
openvdb::Coord coord(const Index3& i)
{
    return {i[0], i[1], i[2]};
}

void number_leaves(Topology& topology, Levels& levels)
{
    levels.leaves.clear();
    levels.level_start.assign(1, 0);
    for (int l = 0; l < levels.count; ++l) {
        for (auto it = topology.blocks[static_cast<std::size_t>(l)].beginLeaf(); it; ++it) {
            it->setTransientData(static_cast<openvdb::Index32>(levels.leaves.size()));
            const openvdb::Coord o = it->origin();
            Leaf leaf;
            leaf.level = l;
            leaf.origin = {o.x(), o.y(), o.z()};
            levels.leaves.push_back(leaf);
        }
        levels.level_start.push_back(static_cast<std::int32_t>(levels.leaves.size()));
    }
}

void find_neighbours(Levels& levels)
{
    for (Leaf& leaf : levels.leaves)
        for (int n = 0; n < 27; ++n) {
            const Index3 offset(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
            leaf.neighbour[static_cast<std::size_t>(n)] = leaf_of(levels, leaf.level, leaf.origin + 8 * offset);
        }
}

void allocate_tiles(Levels& levels)
{
    const std::size_t nodes = levels.leaves.size() * tile_nodes;
    levels.sum.assign(nodes, NodeSum{});
    core::reserve_huge_pages(nodes, levels.motion);
    levels.motion.assign(nodes, NodeMotion{});
    levels.cell_start.clear();
}

void mark_active_cells(const Topology& topology, Levels& levels)
{
    levels.cell_active.assign(levels.leaves.size() * leaf_cells, 0);
    for (std::size_t n = 0; n < levels.leaves.size(); ++n) {
        const Leaf& leaf = levels.leaves[n];
        const auto* mask = topology.cells[static_cast<std::size_t>(leaf.level)].probeConstLeaf(coord(leaf.origin));
        if (mask == nullptr) continue;
        // The mask's bit order, z fastest, is the order of cell_index.
        for (auto it = mask->cbeginValueOn(); it; ++it) levels.cell_active[n * leaf_cells + it.pos()] = 1;
    }
}

/// Add the corners of a leaf's cell to its box, and those that upper neighbours own to theirs.
void use_corners(std::size_t leaf, int cell, Levels& levels)
{
    const std::array<int, 3> local{cell >> 6, cell >> 3 & 7, cell & 7};
    for (int axes = 0; axes < 8; ++axes) { // bit a set: beyond the leaf along axis a
        bool here = true;
        for (int a = 0; a < 3; ++a)
            here = here && ((axes >> a & 1) == 0 || local[static_cast<std::size_t>(a)] + 1 == leaf_side);
        const std::int32_t owner = here ? neighbour(levels.leaves[leaf], axes, 1) : -1;
        if (owner < 0) continue;
        NodeBox& box = levels.used[static_cast<std::size_t>(owner)];
        for (std::size_t a = 0; a < 3; ++a) {
            const bool beyond = (axes >> a & 1) != 0;
            box.lower[a] = std::min(box.lower[a], static_cast<std::int8_t>(beyond ? 0 : local[a]));
            box.upper[a] = std::max(box.upper[a], static_cast<std::int8_t>(beyond ? 0 : local[a] + 1));
        }
    }
}

void find_used_nodes(Levels& levels)
{
    levels.used.assign(levels.leaves.size(), {});
    for (std::size_t n = 0; n < levels.leaves.size(); ++n)
        for (int c = 0; c < leaf_cells; ++c)
            if (levels.cell_active[n * leaf_cells + static_cast<std::size_t>(c)] != 0) use_corners(n, c, levels);
}

/// Cells of `level` that touch the cell, by a corner at least, or contain it or lie in it: the first and the last.
std::array<Index3, 2> range_around(const CellKey& key, int level)
{
    std::array<Index3, 2> range;
    for (int a = 0; a < 3; ++a) {
        const int cell = key.cell[a], coarser = key.level - level;
        range[0][a] = coarser > 0 ? (cell - 1) >> coarser : cell * (1 << -coarser) - 1;
        range[1][a] = coarser > 0 ? (cell + 1) >> coarser : (cell + 1) * (1 << -coarser);
    }
    return range;
}

bool touches_other_level(const Levels& levels, const CellKey& key)
{
    for (int level = 0; level < levels.count; ++level) {
        if (level == key.level) continue;
        const auto [first, last] = range_around(key, level);
        Index3 cell;
        for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0])
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1])
                for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2])
                    if (active_slot(levels, level, cell) >= 0) return true;
    }
    return false;
}
} // namespace

std::int32_t leaf_of(const Levels& levels, int level, const Index3& node)
{
    const auto* leaf = levels.topology->blocks[static_cast<std::size_t>(level)].probeConstLeaf(coord(node));
    return leaf == nullptr ? -1 : static_cast<std::int32_t>(leaf->transientData());
}

std::int64_t slot_of(const Levels& levels, const CellKey& key)
{
    const std::int32_t leaf = leaf_of(levels, key.level, key.cell);
    if (leaf < 0) return -1;
    const Index3 local = key.cell - levels.leaves[static_cast<std::size_t>(leaf)].origin;
    return std::int64_t{leaf} * leaf_cells + cell_index(local[0], local[1], local[2]);
}

std::int64_t active_slot(const Levels& levels, int level, const Index3& cell)
{
    const std::int64_t slot = slot_of(levels, {level, cell});
    return slot >= 0 && levels.cell_active[static_cast<std::size_t>(slot)] != 0 ? slot : -1;
}

std::int64_t activate(const CellKey& key, Levels& levels)
{
    for (int corner = 0; corner < 8; ++corner)
        if (leaf_of(levels, key.level, key.cell + Index3(corner >> 2, corner >> 1 & 1, corner & 1)) < 0) return -1;
    if (touches_other_level(levels, key)) return -1;
    const std::int64_t slot = slot_of(levels, key);
    levels.cell_active[static_cast<std::size_t>(slot)] = 1;
    use_corners(static_cast<std::size_t>(slot / leaf_cells), static_cast<int>(slot % leaf_cells), levels);
    return slot;
}

void build(const std::vector<CellKey>& occupied, Levels& levels)
{
    auto topology = std::make_shared<Topology>();
    topology->cells.resize(static_cast<std::size_t>(levels.count));
    topology->blocks.resize(static_cast<std::size_t>(levels.count));
    for (const CellKey& key : occupied) {
        const auto l = static_cast<std::size_t>(key.level);
        topology->cells[l].setValueOn(coord(key.cell));
        for (int corner = 0; corner < 8; ++corner)
            topology->blocks[l].touchLeaf(coord(key.cell + Index3(corner >> 2, corner >> 1 & 1, corner & 1)));
    }
    levels.topology = topology;
    number_leaves(*topology, levels);
    find_neighbours(levels);
    allocate_tiles(levels);
    mark_active_cells(*topology, levels);
    find_used_nodes(levels);
    build_interfaces(levels);
}

std::vector<CellKey> active_cells(const Levels& levels)
{
    std::vector<CellKey> cells;
    for (std::size_t n = 0; n < levels.leaves.size(); ++n)
        for (int c = 0; c < leaf_cells; ++c)
            if (levels.cell_active[n * leaf_cells + static_cast<std::size_t>(c)] != 0)
                cells.push_back({levels.leaves[n].level, levels.leaves[n].origin + Index3(c / 64, c / 8 % 8, c % 8)});
    return cells;
}

bool before(const CellKey& a, const CellKey& b)
{
    return std::tie(a.level, a.cell[0], a.cell[1], a.cell[2]) < std::tie(b.level, b.cell[0], b.cell[1], b.cell[2]);
}

void sort_unique(std::vector<CellKey>& cells)
{
    const auto keep_first = [&] {
        cells.erase(std::unique(cells.begin(), cells.end(),
                                [](const CellKey& a, const CellKey& b) { return !before(a, b) && !before(b, a); }),
                    cells.end());
    };
    keep_first(); // particles come cell by cell: an eighth is left to sort
    std::sort(cells.begin(), cells.end(), before);
    keep_first();
}

void restore(Levels& levels)
{
    const std::vector<std::uint32_t> cell_start = std::move(levels.cell_start);
    build(active_cells(levels), levels);
    levels.cell_start = cell_start;
}

Refinement refinement_of_cells(const Levels& levels)
{
    Refinement refinement(levels.count);
    for (const CellKey& key : active_cells(levels))
        if (key.level > 0) refinement.subdivide(key.level - 1, parent(key.cell));
    return refinement;
}
} // namespace grid
