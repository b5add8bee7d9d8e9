#include "transfer/gimp_box.h"

#include "grid/topology.h"
#include "transfer/scaled_position.h"

#include <algorithm>
#include <cmath>

namespace transfer
{
namespace
{
Real power_of_two(int n)
{
    return n >= 0 ? static_cast<Real>(1 << n) : 1 / static_cast<Real>(1 << -n);
}

/// x [cells of some level], on a plane of the finest cells if it lies there but for rounding.
Real snap(Real x, Real to_finest, Real from_finest)
{
    const Real near = std::nearbyint(x * to_finest);
    return std::abs(x * to_finest - near) < box_on_plane ? near * from_finest : x;
}

/// An axis of a part in the making: intervals of a box of width `width` around `centre`, in cells.
struct AxisFrame
{
    Real centre, width;
    Real spacing; // mm
};

/// The interval [lower, upper] inside cell `cell`.
BoxAxis interval(const AxisFrame& frame, Real lower, Real upper, int cell)
{
    const Real share = (upper - lower) / frame.width;
    const Real xi = Real(0.5) * (lower + upper) - static_cast<Real>(cell);
    const Real arm = (static_cast<Real>(cell) - frame.centre) * frame.spacing;
    return {
        {share * (1 - xi), share * xi}, {-share / frame.spacing, share / frame.spacing}, {arm, arm + frame.spacing}};
}

/// Turn an axis whose interval is the reflection at node plane `wall` into what it means for the particle.
void reflect(const AxisFrame& frame, int wall, int cell, BoxAxis& axis)
{
    axis.sign = -1;
    for (int n = 0; n < 2; ++n) {
        axis.slope[n] = -axis.slope[n];
        axis.arm[n] = (static_cast<Real>(2 * wall - cell - n) - frame.centre) * frame.spacing;
    }
}

/// Everything about one particle while its box is cut, from level 0 down.
struct Cut
{
    const BoxCutter& cutter;
    BoxBounds bounds; // whole box, in finest cells
    Vec3 centre;      // of the particle, in finest cells
    int finest;
    std::vector<BoxPart>& parts;
    BoxBounds piece;                 // of the box; reflected where `reflected`
    std::array<bool, 3> reflected{}; // the present piece
    std::array<int, 3> wall{};       // in finest cells
    bool complete = true;

    void emit(int level, const Index3& cell)
    {
        const std::int64_t slot = grid::active_slot(cutter.levels, level, cell);
        if (slot < 0) {
            complete = false;
            return;
        }
        BoxPart part;
        part.leaf = static_cast<std::int32_t>(slot / grid::leaf_cells);
        part.cell = static_cast<std::int32_t>(slot % grid::leaf_cells);
        part.node = grid::tile_index(part.cell >> 6, part.cell >> 3 & 7, part.cell & 7);
        const Real scale = power_of_two(level - finest);
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            part.corner[axis] = cell[a] << (finest - level);
            const AxisFrame frame{scale * centre[a], scale * (bounds.upper[a] - bounds.lower[a]),
                                  cutter.levels.spacing(level)};
            const Real lower = std::max(scale * piece.lower[a], static_cast<Real>(cell[a]));
            const Real upper = std::min(scale * piece.upper[a], static_cast<Real>(cell[a] + 1));
            part.axis[a] = interval(frame, lower, upper, cell[a]);
            if (!reflected[axis]) continue;
            reflect(frame, wall[axis] >> (finest - level), cell[a], part.axis[a]);
            part.reflected = true;
        }
        parts.push_back(part);
    }

    void descend(int level, const Index3& cell)
    {
        if (level == finest || !cutter.refinement.subdivided(level, cell)) return emit(level, cell);
        const Real width = power_of_two(finest - level - 1);
        for (int c = 0; c < 8; ++c) {
            const Index3 child = 2 * cell + Index3(c >> 2, c >> 1 & 1, c & 1);
            bool overlaps = true;
            for (int a = 0; a < 3; ++a)
                overlaps = overlaps && piece.lower[a] < width * (child[a] + 1) && piece.upper[a] > width * child[a];
            if (overlaps) descend(level + 1, child);
        }
    }

    /// The cells of the present piece, in an order that does not depend on how many coarser levels there are.
    void cells()
    {
        const auto first = static_cast<std::ptrdiff_t>(parts.size());
        const Real scale = power_of_two(-finest);
        const CellRange range = cells_between({scale * piece.lower, scale * piece.upper});
        for (int i = range.first[0]; i <= range.last[0]; ++i)
            for (int j = range.first[1]; j <= range.last[1]; ++j)
                for (int k = range.first[2]; k <= range.last[2]; ++k) descend(0, Index3(i, j, k));
        std::sort(parts.begin() + first, parts.end(),
                  [](const BoxPart& a, const BoxPart& b) { return a.corner < b.corner; });
    }

    /// The box in one to eight pieces, those beyond a wall reflected.
    void fold(int a)
    {
        if (a == 3) return cells();
        const auto axis = static_cast<std::size_t>(a);
        for (const grid::WallPlane& plane : cutter.options.walls) {
            const int at = plane.node0 << finest;
            if (plane.axis != a || !(piece.lower[a] < at && piece.upper[a] > at)) continue;
            const BoxBounds whole = piece;
            const bool above = centre[a] >= at;
            (above ? piece.lower : piece.upper)[a] = at;
            fold(a + 1);
            piece = whole;
            wall[axis] = at;
            reflected[axis] = true;
            piece.lower[a] = above ? Real(at) : 2 * at - whole.upper[a];
            piece.upper[a] = above ? 2 * at - whole.lower[a] : Real(at);
            fold(a + 1);
            piece = whole;
            reflected[axis] = false;
            return;
        }
        fold(a + 1);
    }
};
} // namespace

Real box_half_width(const PassOptions& options, int size_level, int level)
{
    return Real(0.5) / options.per_axis * power_of_two(level - size_level);
}

BoxBounds snapped(const BoxBounds& bounds, int level, int finest)
{
    const Real scale = power_of_two(finest - level), back = 1 / scale;
    BoxBounds s = bounds;
    for (int a = 0; a < 3; ++a) {
        s.lower[a] = snap(bounds.lower[a], scale, back);
        s.upper[a] = snap(bounds.upper[a], scale, back);
    }
    return s;
}

namespace
{
/// Where a particle is, in cells of `level`: with the rounding of the kernels' test of the home cell (chunk.h, inside).
Vec3 centre_of(const grid::Levels& levels, const particles::Particles& particles, std::size_t p, int level)
{
    const Real per_spacing = Real(1) / levels.spacing(level);
    return (Vec3(particles.position[0][p], particles.position[1][p], particles.position[2][p]) - levels.origin) *
           per_spacing;
}
} // namespace

BoxBounds box_bounds(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                     std::size_t p, int level, Real margin)
{
    const Vec3 centre = centre_of(levels, particles, p, level);
    const int size = particles.size_level[p];
    const Vec3 half = Vec3::Constant(box_half_width(options, size, level) + margin * power_of_two(level - size));
    return snapped({centre - half, centre + half}, level, levels.count - 1);
}

CellRange cells_between(const BoxBounds& bounds)
{
    CellRange range;
    for (int a = 0; a < 3; ++a) {
        range.first[a] = static_cast<int>(std::floor(bounds.lower[a]));
        range.last[a] = static_cast<int>(std::ceil(bounds.upper[a])) - 1;
    }
    return range;
}

bool BoxCutter::cut(const particles::Particles& particles, std::size_t p, std::vector<BoxPart>& parts) const
{
    const int finest = levels.count - 1;
    const Vec3 centre = centre_of(levels, particles, p, finest);
    if (!is_place(centre)) return false; // whoever places the particles names it (strays.cpp)
    const BoxBounds bounds = box_bounds(options, levels, particles, p, finest);
    Cut cut{*this, bounds, centre, finest, parts, bounds};
    cut.fold(0);
    return cut.complete;
}
} // namespace transfer
