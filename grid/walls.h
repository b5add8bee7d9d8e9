/// Symmetry planes, and walks over the nodes a leaf owns.
#pragma once

#include "grid/levels.h"

#include <algorithm>
#include <vector>

namespace grid
{
/// A coordinate plane of nodes with zero normal velocity.
struct WallPlane
{
    int axis = 2;
    int node0 = 0; // index of the plane's nodes on level 0; 2^l node0 on level l
};

/// `fix(motion, axis)` for every node of the leaf that lies on a wall.
template <class Fix>
void fix_walls(const std::vector<WallPlane>& walls, const Leaf& leaf, NodeMotion* motion, const Fix& fix)
{
    for (const WallPlane& wall : walls) {
        const int at = (wall.node0 << leaf.level) - leaf.origin[wall.axis];
        if (at < 0 || at >= leaf_side) continue;
        for (int a = 0; a < leaf_side; ++a)
            for (int b = 0; b < leaf_side; ++b) {
                int node[3];
                node[wall.axis] = at;
                node[(wall.axis + 1) % 3] = a;
                node[(wall.axis + 2) % 3] = b;
                fix(motion[tile_index(node[0], node[1], node[2])], static_cast<std::size_t>(wall.axis));
            }
    }
}

/// `visit(node)` for the nodes of a box up to index `last` along each axis.
template <class Visit>
void for_nodes(const NodeBox& box, int last, const Visit& visit)
{
    const auto end = [&](std::size_t a) { return std::min<int>(last, box.upper[a]); };
    for (int i = box.lower[0]; i <= end(0); ++i)
        for (int j = box.lower[1]; j <= end(1); ++j)
            for (int k = box.lower[2]; k <= end(2); ++k) visit(tile_index(i, j, k));
}

/// Every node a leaf owns.
template <class Visit>
void for_owned_nodes(const Visit& visit)
{
    for_nodes(whole_tile, leaf_side - 1, visit);
}
} // namespace grid
