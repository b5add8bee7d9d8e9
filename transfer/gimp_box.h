/// Particle boxes of the basis `gimp`, cut by the leaf cells they touch.
///
/// A particle is a box B of constant half widths, the sub-cell it was seeded in: spacing0 / 2^size_level / (2
/// per_axis). Its weight on a node is the mean of the trilinear weight over the box. The leaf cells cut the box into
/// sub-boxes b, and on each of them the weight is multilinear, so its mean is its value in the centre of b:
///
///     Phi_a = sum_b |b| / |B| N_a(centre of b),      grad Phi_a = sum_b |b| / |B| grad N_a(centre of b)
///
/// exactly, also across level interfaces (methods.md A.3.3). Sub-boxes in one leaf, in cells of one level, form a
/// tensor product: a `BoxPart` of two or three nodes per axis in the tile of that leaf. Nearly every box is a single
/// part.
///
/// A box that reaches through a symmetry plane is reflected there: the part beyond acts on the mirror images of its
/// nodes, whose normal velocity has the other sign. So a half model is half of the whole one, to round-off.
#pragma once

#include "grid/levels.h"
#include "grid/refinement.h"
#include "particles/particles.h"
#include "transfer/passes.h"

#include <vector>

namespace transfer
{
/// One axis of a part: weights, their slopes and the nodes' distances from the particle.
struct BoxAxis
{
    int count = 2;       // nodes
    Real weight[3] = {}; // 1
    Real slope[3] = {};  // 1/mm
    Real arm[3] = {};    // mm, node minus particle
    Real sign = 1;       // -1: reflected at a symmetry plane
};

struct BoxPart
{
    std::int32_t leaf = -1;
    std::int32_t node = 0;  // lowest node in the leaf's tile
    std::int32_t cell = -1; // of the leaf, if the part lies in one; -1: several
    BoxAxis axis[3];
    bool reflected = false;
};

struct BoxParts
{
    std::vector<BoxPart> part;
    bool outside = false; // some sub-box lies in a cell that is not active: it is missing, cells must be built first
};

/// What cutting needs to know; made once per pass.
struct BoxCutter
{
    const PassOptions& options;
    const grid::Levels& levels;
    const grid::Refinement& refinement;
    std::vector<std::uint8_t> hangs; // [leaf] 1: APIC, and some cell has a hanging corner: one part per cell there

    BoxCutter(const PassOptions& pass, const grid::Levels& all, const grid::Refinement& cells);

    /// Parts of particle p, which is stored under `home`, in a fixed order.
    void cut(const particles::Particles& particles, std::size_t p, std::size_t home, BoxParts& parts) const;

private:
    /// The common case: the box lies in active cells of its home leaf, away from walls and hanging corners.
    bool cut_at_home(const particles::Particles& particles, std::size_t p, std::size_t home, BoxPart& part) const;
};

/// Share of (cell width / wave speed) that a step may not exceed: the smallest stable step over all places of the boxes
/// in one dimension (methods.md A.3.4), times that of a cube in three (A.6).
inline Real box_step_share(int per_axis)
{
    constexpr Real line[] = {0.87, 0.80, 0.73, 0.66};
    constexpr Real cube = 0.73;
    return cube * line[per_axis < 4 ? per_axis - 1 : 3];
}

/// Half width of a particle's box, in cells of `level` [1].
Real box_half_width(const PassOptions& options, const particles::Particles& particles, std::size_t p, int level);

/// Bounds of a box in cells of some level; `snapped` moves bounds that lie on a plane of the finest cells but for
/// rounding onto it, so that boxes at rest touch no neighbour.
struct BoxBounds
{
    Vec3 lower, upper;
};
BoxBounds snapped(const BoxBounds& bounds, int level, int finest);

/// Bounds of a particle's box, snapped, in cells of `level`; half widths grown by `margin` cells of the particle's own
/// size level.
BoxBounds box_bounds(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                     std::size_t p, int level, Real margin = 0);

/// First and last cell that overlap [lower, upper].
struct CellRange
{
    Index3 first, last;
};
CellRange cells_between(const BoxBounds& bounds);

/// Leaf of `level` and number of a cell near leaf `home` of the same level, through its neighbours; leaf -1: none
/// there, or further away.
struct CellPlace
{
    std::int32_t leaf, cell;
};
inline CellPlace place_near(const grid::Levels& levels, std::size_t home, const Index3& cell)
{
    const grid::Leaf& leaf = levels.leaves[home];
    const Index3 local = cell - leaf.origin;
    int neighbour = 0;
    for (int a = 0; a < 3; ++a) {
        const int step = local[a] >> 3;
        if (step < -1 || step > 1) return {-1, 0};
        neighbour = 3 * neighbour + step + 1;
    }
    return {leaf.neighbour[static_cast<std::size_t>(neighbour)],
            grid::cell_index(local[0] & 7, local[1] & 7, local[2] & 7)};
}

inline bool is_active(const grid::Levels& levels, const CellPlace& at)
{
    return at.leaf >= 0 && levels.cell_active[static_cast<std::size_t>(at.leaf) * grid::leaf_cells +
                                              static_cast<std::size_t>(at.cell)] != 0;
}
} // namespace transfer
