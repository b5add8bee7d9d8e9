/// Walk over the strays, each in the leaf and cell it is in now.
#pragma once

#include "core/parallel.h"
#include "transfer/chunk.h"
#include "transfer/strays.h"

namespace transfer
{
/// `visit(s, leaf, p)` for every stray s, particle p. Leaf by leaf in parallel: whoever writes to a leaf's tile is
/// alone.
template <class Visit>
void for_each_stray(const Strays& strays, const Visit& visit)
{
    if (strays.size() == 0) return;
    core::parallel_for(strays.run.size() - 1, [&](std::size_t r) {
        for (std::uint32_t s = strays.run[r]; s < strays.run[r + 1]; ++s)
            visit(s, static_cast<std::size_t>(strays.leaf[s]), strays.particle[s]);
    });
}

/// The cell a stray is in.
inline CellFrame frame_of_stray(const grid::Levels& levels, const Strays& strays, std::uint32_t s)
{
    return cell_frame(leaf_frame(levels, static_cast<std::size_t>(strays.leaf[s])), strays.cell[s]);
}
} // namespace transfer
