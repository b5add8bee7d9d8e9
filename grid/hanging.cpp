#include "grid/hanging.h"

#include "core/parallel.h"
#include "grid/topology.h"

#include <algorithm>

namespace grid
{
namespace
{
/// One corner of one cell that hangs.
struct HangingCorner
{
    std::int64_t slot;
    std::int32_t corner, slave;
};

std::array<std::int32_t, 8> none()
{
    return {-1, -1, -1, -1, -1, -1, -1, -1};
}

std::vector<HangingCorner> hanging_corners(const Levels& levels, int level, const LevelInterface& face)
{
    std::vector<HangingCorner> corners;
    for (std::size_t s = 0; s < face.slave.size(); ++s) {
        if (face.row_start[s + 1] - face.row_start[s] == 1) continue; // sits on its master
        const int place = face.slave[s].node;
        const Index3 node = levels.leaves[static_cast<std::size_t>(face.slave[s].leaf)].origin +
                            Index3(place / (tile_side * tile_side), place / tile_side % tile_side, place % tile_side);
        for (std::int32_t c = 0; c < 8; ++c) {
            const std::int64_t slot = active_slot(levels, level, node - Index3(c >> 2, c >> 1 & 1, c & 1));
            if (slot >= 0) corners.push_back({slot, c, static_cast<std::int32_t>(s)});
        }
    }
    std::sort(corners.begin(), corners.end(), [](const HangingCorner& a, const HangingCorner& b) {
        return a.slot != b.slot ? a.slot < b.slot : a.corner < b.corner;
    });
    return corners;
}
} // namespace

void find_hanging_cells(const Levels& levels, int level, LevelInterface& face)
{
    HangingCells& hanging = face.hanging;
    hanging.around.assign(face.slave.size(), none());
    for (const HangingCorner& at : hanging_corners(levels, level, face)) {
        const auto slot = static_cast<std::size_t>(at.slot);
        if (hanging.slot.empty() || hanging.slot.back() != slot) {
            hanging.slot.push_back(slot);
            hanging.slave.push_back(none());
        }
        const auto corner = static_cast<std::size_t>(at.corner);
        hanging.slave.back()[corner] = at.slave;
        hanging.around[static_cast<std::size_t>(at.slave)][corner] = static_cast<std::int32_t>(hanging.slot.size() - 1);
    }
}

void keep_affine(Levels& levels)
{
    for (LevelInterface& face : levels.interface) {
        face.hanging.affine.resize(face.hanging.slot.size());
        face.hanging.slave_affine.resize(face.slave.size());
    }
}

void restrict_affine(std::size_t face, Levels& levels)
{
    LevelInterface& interface = levels.interface[face];
    HangingCells& hanging = interface.hanging;
    if (hanging.affine.empty()) return;
    core::parallel_for(interface.slave.size(), [&](std::size_t s) {
        std::array<Real, 9> sum{};
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const std::int32_t cell = hanging.around[s][corner];
            if (cell < 0) continue;
            for (std::size_t n = 0; n < 9; ++n)
                sum[n] += hanging.affine[static_cast<std::size_t>(cell)].entry[n][corner];
        }
        hanging.slave_affine[s] = sum;
    });
    const Real spacing = levels.spacing(static_cast<int>(face) + 1);
    core::parallel_for(interface.master.size(), [&](std::size_t m) {
        const NodeAddress& at = interface.master[m];
        NodeSum& master = levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
        for (std::int32_t e = interface.column_start[m]; e < interface.column_start[m + 1]; ++e) {
            const auto entry = static_cast<std::size_t>(e);
            const std::array<Real, 9>& t =
                hanging.slave_affine[static_cast<std::size_t>(interface.column_slave[entry])];
            const MasterOffset& offset = interface.column_offset[entry];
            const Real scale = interface.column_weight[entry] * spacing;
            for (std::size_t a = 0; a < 3; ++a)
                master.momentum[a] +=
                    scale * (t[3 * a] * offset[0] + t[3 * a + 1] * offset[1] + t[3 * a + 2] * offset[2]);
        }
    });
}
} // namespace grid
