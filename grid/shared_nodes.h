/// Nodes that the tiles of neighbouring leaves share.
#pragma once

#include "grid/levels.h"

namespace grid
{
/// Ranges of the nodes one leaf shares with its neighbour in direction `axes` (bit a set: one step along axis a).
/// Calls visit(own node, halo node of the lower partner) for each shared node.
template <class Visit>
void for_shared_nodes(int axes, const Visit& visit)
{
    const int ni = axes & 1 ? 1 : leaf_side;
    const int nj = axes & 2 ? 1 : leaf_side;
    const int nk = axes & 4 ? 1 : leaf_side;
    const int hi = axes & 1 ? leaf_side : 0;
    const int hj = axes & 2 ? leaf_side : 0;
    const int hk = axes & 4 ? leaf_side : 0;
    for (int i = 0; i < ni; ++i)
        for (int j = 0; j < nj; ++j)
            for (int k = 0; k < nk; ++k) visit(tile_index(i, j, k), tile_index(i + hi, j + hj, k + hk));
}

/// The leaf that lies one step along the axes of `axes`, towards `sign`, or -1.
inline std::int32_t neighbour(const Leaf& leaf, int axes, int sign)
{
    const int a = axes & 1 ? sign : 0;
    const int b = axes & 2 ? sign : 0;
    const int c = axes & 4 ? sign : 0;
    return leaf.neighbour[static_cast<std::size_t>(9 * a + 3 * b + c + 13)];
}
} // namespace grid
