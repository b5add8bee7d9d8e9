/// Nodes that the tiles of neighbouring leaves share.
#pragma once

#include "grid/levels.h"

#include <algorithm>

namespace grid
{
/// Ranges of the nodes one leaf shares with its neighbour in direction `axes` (bit a set: one step along axis a), as
/// far as they lie in `box` along the other axes. Calls visit(own node, halo node of the lower partner) for each.
template <class Visit>
void for_shared_nodes(int axes, const NodeBox& box, const Visit& visit)
{
    const auto lower = [&](int a) {
        return axes >> a & 1 ? 0 : static_cast<int>(box.lower[static_cast<std::size_t>(a)]);
    };
    const auto upper = [&](int a) {
        return axes >> a & 1 ? 1 : std::min(leaf_side, box.upper[static_cast<std::size_t>(a)] + 1);
    };
    const auto halo = [&](int a) { return axes >> a & 1 ? leaf_side : 0; };
    for (int i = lower(0); i < upper(0); ++i)
        for (int j = lower(1); j < upper(1); ++j)
            for (int k = lower(2); k < upper(2); ++k)
                visit(tile_index(i, j, k), tile_index(i + halo(0), j + halo(1), k + halo(2)));
}

/// The leaf that lies one step along the axes of `axes`, towards `sign`, or -1.
inline std::int32_t neighbour(const Leaf& leaf, int axes, int sign)
{
    const int a = axes & 1 ? sign : 0;
    const int b = axes & 2 ? sign : 0;
    const int c = axes & 4 ? sign : 0;
    return leaf.neighbour[static_cast<std::size_t>(9 * a + 3 * b + c + 13)];
}

/// `add(lower leaf, own node, halo node)` for every halo entry of the seven lower neighbours of a leaf, in a fixed
/// order.
template <class Add>
void for_lower_halos(const Levels& levels, std::size_t leaf, const Add& add)
{
    for (int axes = 1; axes < 8; ++axes) {
        const std::int32_t lower = neighbour(levels.leaves[leaf], axes, -1);
        if (lower < 0) continue;
        for_shared_nodes(axes, levels.used[leaf],
                         [&](int mine, int halo) { add(static_cast<std::size_t>(lower), mine, halo); });
    }
}
} // namespace grid
