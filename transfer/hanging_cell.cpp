#include "transfer/hanging_cell.h"

#include <algorithm>

namespace transfer
{
HangingRange hanging_cells(const grid::Levels& levels, std::size_t leaf)
{
    const int level = levels.leaves[leaf].level;
    if (level == 0) return {};
    const grid::LevelInterface& face = levels.interface[static_cast<std::size_t>(level - 1)];
    const std::vector<std::size_t>& slot = face.hanging.slot;
    const auto place = [&](std::size_t of_leaf) {
        return static_cast<std::size_t>(std::lower_bound(slot.begin(), slot.end(), of_leaf * grid::leaf_cells) -
                                        slot.begin());
    };
    return {&face, place(leaf), place(leaf + 1)};
}

HangingRange narrowed(const HangingRange& range, std::size_t slot)
{
    if (range.begin == range.end) return range;
    const std::vector<std::size_t>& all = range.face->hanging.slot;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto last = all.begin() + static_cast<std::ptrdiff_t>(range.end);
    const auto found = std::equal_range(first, last, slot);
    return {range.face, static_cast<std::size_t>(found.first - all.begin()),
            static_cast<std::size_t>(found.second - all.begin())};
}

HangingSlopes read_slopes(const grid::Levels& levels, const grid::LevelInterface& face, std::size_t c)
{
    HangingSlopes masters;
    const std::size_t cell = face.hanging.slot[c] % grid::leaf_cells;
    // A leaf starts at a multiple of 8: indices in the leaf have the parity of indices on the level.
    const std::array<std::size_t, 3> local{cell >> 6, cell >> 3 & 7, cell & 7};
    for (std::size_t a = 0; a < 3; ++a) masters.odd[a] = (local[a] & 1) == 0 ? 1 : 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        if (face.hanging.slave[c][corner] < 0) continue;
        const auto s = static_cast<std::size_t>(face.hanging.slave[c][corner]);
        const std::array<std::size_t, 3> side{corner >> 2, corner >> 1 & 1, corner & 1};
        for (std::size_t a = 0; a < 3; ++a) {
            if (static_cast<int>(side[a]) != masters.odd[a]) continue;
            const std::size_t j = 2 * side[(a + 1) % 3] + side[(a + 2) % 3];
            masters.any[a] = masters.hangs[a][j] = true;
            std::array<Real, 3>& slope = masters.slope[a][j];
            for (auto e = static_cast<std::size_t>(face.row_start[s]);
                 e < static_cast<std::size_t>(face.row_start[s + 1]); ++e) {
                const grid::NodeAddress& at = face.row_master[e];
                const grid::NodeMotion& master = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
                for (std::size_t d = 0; d < 3; ++d)
                    slope[d] += face.row_weight[e] * face.row_offset[e][a] * master.velocity[d];
            }
        }
    }
    return masters;
}
} // namespace transfer
