#include "tests/support/topologies.h"

#include "grid/topology.h"

#include <algorithm>
#include <ostream>

namespace support
{
namespace
{
Index3 child(const Index3& cell, int c)
{
    return 2 * cell + Index3(c >> 2, c >> 1 & 1, c & 1);
}

template <class Visit>
void for_block(int half, const Visit& visit)
{
    for (int i = -half; i < half; ++i)
        for (int j = -half; j < half; ++j)
            for (int k = -half; k < half; ++k) visit(grid::CellKey{0, Index3(i, j, k)});
}

void refine(const std::function<bool(const grid::CellKey&)>& wanted, const grid::CellKey& key,
            grid::Refinement& refinement)
{
    if (key.level + 1 >= refinement.levels()) return;
    if (wanted(key)) refinement.subdivide(key.level, key.cell);
    for (int c = 0; c < 8; ++c) refine(wanted, {key.level + 1, child(key.cell, c)}, refinement);
}

void collect(const grid::Refinement& refinement, const grid::CellKey& key, std::vector<grid::CellKey>& cells)
{
    if (key.level + 1 >= refinement.levels() || !refinement.subdivided(key.level, key.cell)) {
        cells.push_back(key);
        return;
    }
    for (int c = 0; c < 8; ++c) collect(refinement, {key.level + 1, child(key.cell, c)}, cells);
}

bool within(const grid::CellKey& key, int half)
{
    return key.cell.minCoeff() >= -half && key.cell.maxCoeff() < half;
}
} // namespace

Topology topology_of(const std::string& name, int levels, int half,
                     const std::function<bool(const grid::CellKey&)>& wanted)
{
    Topology topology{name, grid::Refinement(levels), {}};
    for_block(half, [&](const grid::CellKey& key) { refine(wanted, key, topology.refinement); });
    topology.refinement.balance();
    for_block(half, [&](const grid::CellKey& key) { collect(topology.refinement, key, topology.cells); });
    return topology;
}

const std::vector<Topology>& topologies()
{
    static const std::vector<Topology> all{
        topology_of("one level", 1, 2, [](const auto&) { return false; }),
        topology_of("flat face", 2, 2, [](const auto& key) { return key.cell[0] < 0; }),
        topology_of("box zone", 2, 3, [](const auto& key) { return within(key, 1); }),
        topology_of("re-entrant zone", 2, 2, [](const auto& key) { return key.cell.minCoeff() < 0; }),
        topology_of(
            "three nested levels", 3, 4,
            [](const auto& key) { return key.level == 1 && key.cell.minCoeff() >= 0 && key.cell.maxCoeff() < 3; }),
        topology_of("all refined", 2, 2, [](const auto&) { return true; }),
    };
    return all;
}

grid::Levels levels_of(const Topology& topology, Real spacing0)
{
    grid::Levels levels;
    levels.spacing0 = spacing0;
    levels.count = topology.refinement.levels();
    levels.origin = Vec3(0.3, -0.7, 1.1);
    grid::build(topology.cells, levels);
    return levels;
}

Vec3 position_of(const grid::Levels& levels, const grid::NodeAddress& at)
{
    const grid::Leaf& leaf = levels.leaves[static_cast<std::size_t>(at.leaf)];
    const Index3 local(at.node / 81, at.node / 9 % 9, at.node % 9);
    return levels.origin + levels.spacing(leaf.level) * (leaf.origin + local).cast<Real>();
}

void for_each_free_node(const grid::Levels& levels,
                        const std::function<void(const grid::NodeAddress&, const Vec3&)>& visit)
{
    // Corners of cells are marked in the tile of the cell's leaf; the owner of a halo corner is the upper neighbour.
    std::vector<std::uint8_t> corner(levels.leaves.size() * grid::tile_nodes, 0);
    for (std::size_t n = 0; n < levels.leaves.size(); ++n)
        for (int c = 0; c < grid::leaf_cells; ++c) {
            if (levels.cell_active[n * grid::leaf_cells + static_cast<std::size_t>(c)] == 0) continue;
            for (int v = 0; v < 8; ++v) {
                const Index3 node =
                    levels.leaves[n].origin + Index3(c / 64, c / 8 % 8, c % 8) + Index3(v >> 2, v >> 1 & 1, v & 1);
                const auto owner = static_cast<std::size_t>(grid::leaf_of(levels, levels.leaves[n].level, node));
                const Index3 local = node - levels.leaves[owner].origin;
                corner[owner * grid::tile_nodes +
                       static_cast<std::size_t>(grid::tile_index(local[0], local[1], local[2]))] = 1;
            }
        }
    for (std::size_t i = 0; i < corner.size(); ++i) {
        if (corner[i] == 0 || levels.constrained[i] != 0) continue;
        const grid::NodeAddress at{static_cast<std::int32_t>(i / grid::tile_nodes),
                                   static_cast<std::int32_t>(i % grid::tile_nodes)};
        visit(at, position_of(levels, at));
    }
}

std::ostream& operator<<(std::ostream& out, const Topology& topology)
{
    return out << topology.name;
}
} // namespace support
