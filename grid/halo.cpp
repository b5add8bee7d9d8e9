#include "grid/halo.h"

#include "core/parallel.h"
#include "grid/shared_nodes.h"

namespace grid
{
namespace
{
/// `add(own, halo)` for every halo entry of the lower neighbours of every leaf.
template <class Add>
void gather_from_lower(Levels& levels, const Add& add)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        NodeSum* own = levels.sums(n);
        for_lower_halos(levels, n,
                        [&](std::size_t lower, int mine, int halo) { add(own[mine], levels.sums(lower)[halo]); });
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

void fill_motion_halos(Levels& levels, int first_level)
{
    const std::size_t first = levels.first_leaf(first_level);
    core::parallel_for(levels.leaves.size() - first, [&](std::size_t task) {
        const std::size_t n = first + task;
        NodeMotion* own = levels.motions(n);
        for (int axes = 1; axes < 8; ++axes) {
            const std::int32_t upper = neighbour(levels.leaves[n], axes, 1);
            if (upper < 0) continue;
            const NodeMotion* other = levels.motions(static_cast<std::size_t>(upper));
            for_shared_nodes(axes, levels.used[n], [&](int theirs, int halo) { own[halo] = other[theirs]; });
        }
    });
}
} // namespace grid
