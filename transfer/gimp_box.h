/// Particle boxes of the basis `gimp`, cut by the leaf cells they touch.
///
/// A particle is a box B of constant half widths, the sub-cell it was seeded in: spacing0 / 2^size_level / (2
/// per_axis). Its weight on a node is the mean of the trilinear weight over the box. The leaf cells cut the box into
/// sub-boxes b, and on each of them the weight is multilinear, so its mean is its value in the centre of b:
///
///     Phi_a = sum_b |b| / |B| N_a(centre of b),      grad Phi_a = sum_b |b| / |B| grad N_a(centre of b)
///
/// exactly, also across level interfaces (methods.md A.3.3). Nearly every box touches cells of one level only and has
/// weights in closed form (gimp_weights.h); the cutter here serves the rest, and says what both mean.
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
/// What cutting needs to know.
struct BoxCutter
{
    const PassOptions& options;
    const grid::Levels& levels;
    const grid::Refinement& refinement;

    /// Add the parts of the box of particle p, in the order of their cells.
    /// @return whether all its cells are active (and its position a number); if not, the part is missing
    bool cut(const particles::Particles& particles, std::size_t p, std::vector<BoxPart>& parts) const;
};

/// Share of (cell width / wave speed) that a step may not exceed: the smallest stable step over all places of the boxes
/// in one dimension (methods.md A.3.4), times that of a cube in three (A.6).
inline Real box_step_share(int per_axis)
{
    constexpr Real line[] = {0.87, 0.80, 0.73, 0.66};
    constexpr Real cube = 0.73;
    return cube * line[per_axis < 4 ? per_axis - 1 : 3];
}

/// Bounds of boxes nearer to a plane of cells than this are on it [cells].
inline constexpr Real box_on_plane = 1e-12;

/// Half width of a box of some size level, in cells of `level` [1].
Real box_half_width(const PassOptions& options, int size_level, int level);

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
} // namespace transfer
