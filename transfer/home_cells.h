/// Walk over particles together with the cell each is in now, for work beside the passes.
#pragma once

#include "transfer/each_stray.h"

#include <algorithm>

namespace transfer
{
/// Call `serve(leaf, frame, p)` for every particle; leaf by leaf in parallel, strays afterwards in the leaf they are
/// in, so whoever writes to a leaf's tile is alone. Leaves are passed over where `idle(begin, end)` says that none of
/// their particles [begin, end) needs serving.
template <class Idle, class Serve>
void for_each_in_cell(const Strays& strays, const particles::Particles& particles, const grid::Levels& levels,
                      const Idle& idle, const Serve& serve)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
        if (idle(start[0], start[grid::leaf_cells])) return;
        const LeafFrame leaf = leaf_frame(levels, n);
        for (int c = 0; c < grid::leaf_cells; ++c)
            for (std::uint32_t p = start[c]; p < start[c + 1]; ++p)
                if (particles.away[p] == 0) serve(n, cell_frame(leaf, c), p);
    });
    for_each_stray(strays, [&](std::uint32_t s, std::size_t leaf, std::uint32_t p) {
        serve(leaf, frame_of_stray(levels, strays, s), p);
    });
}

/// Place of a point in a cell; a point beyond the cell counts at its face.
inline LocalPosition<Real> clamped_position(const CellFrame& frame, const Vec3& x)
{
    LocalPosition<Real> at = local_position(frame, core::Vec<Real>{{x[0], x[1], x[2]}});
    for (Real* local : {&at.xi, &at.eta, &at.zeta}) *local = std::clamp(*local, Real(0), Real(1));
    return at;
}

/// `visit(node, weight)` for the eight corners of the cell.
template <class Visit>
void for_corners(const CellFrame& frame, const LocalPosition<Real>& at, const Visit& visit)
{
    for (int c = 0; c < 8; ++c) {
        const int i = c >> 2, j = c >> 1 & 1, k = c & 1;
        const Real weight = (i ? at.xi : 1 - at.xi) * (j ? at.eta : 1 - at.eta) * (k ? at.zeta : 1 - at.zeta);
        visit(frame.node + grid::tile_index(i, j, k), weight);
    }
}
} // namespace transfer
