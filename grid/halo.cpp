#include "grid/halo.h"

#include "core/parallel.h"

namespace grid
{
namespace
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

std::int32_t neighbour(const Leaf& leaf, int axes, int sign)
{
    const int a = axes & 1 ? sign : 0;
    const int b = axes & 2 ? sign : 0;
    const int c = axes & 4 ? sign : 0;
    return leaf.neighbour[static_cast<std::size_t>(9 * a + 3 * b + c + 13)];
}

/// `add(own, halo)` for every halo entry of the seven lower neighbours, in the fixed order of `axes`.
template <class Add>
void gather_from_lower(Levels& levels, const Add& add)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        NodeSum* own = levels.sums(n);
        for (int axes = 1; axes < 8; ++axes) {
            const std::int32_t lower = neighbour(levels.leaves[n], axes, -1);
            if (lower < 0) continue;
            const NodeSum* other = levels.sums(static_cast<std::size_t>(lower));
            for_shared_nodes(axes, [&](int mine, int halo) { add(own[mine], other[halo]); });
        }
    });
}
} // namespace

void assemble_sums(Levels& levels)
{
    gather_from_lower(levels, [](NodeSum& own, const NodeSum& halo) {
        own.mass += halo.mass;
        for (std::size_t a = 0; a < 3; ++a) {
            own.momentum[a] += halo.momentum[a];
            own.force[a] += halo.force[a];
        }
    });
}

void assemble_momentum(Levels& levels)
{
    gather_from_lower(levels, [](NodeSum& own, const NodeSum& halo) {
        for (std::size_t a = 0; a < 3; ++a) own.momentum[a] += halo.momentum[a];
    });
}

void fill_motion_halos(Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        NodeMotion* own = levels.motions(n);
        for (int axes = 1; axes < 8; ++axes) {
            const std::int32_t upper = neighbour(levels.leaves[n], axes, 1);
            if (upper < 0) continue;
            const NodeMotion* other = levels.motions(static_cast<std::size_t>(upper));
            for_shared_nodes(axes, [&](int theirs, int halo) { own[halo] = other[theirs]; });
        }
    });
}
} // namespace grid
