#include "transfer/gimp_box.h"

#include "grid/topology.h"
#include "transfer/hanging_cell.h"

#include <algorithm>
#include <cmath>

namespace transfer
{
namespace
{
/// Bounds nearer to a plane of cells than this are on it [cells].
constexpr Real on_plane = 1e-12;

Real power_of_two(int n)
{
    return n >= 0 ? static_cast<Real>(1 << n) : 1 / static_cast<Real>(1 << -n);
}

/// x [cells of some level], on a plane of the finest cells if it lies there but for rounding.
Real snap(Real x, Real to_finest, Real from_finest)
{
    const Real near = std::nearbyint(x * to_finest);
    return std::abs(x * to_finest - near) < on_plane ? near * from_finest : x;
}

/// An axis of a part in the making: intervals of a box of width `width` around `centre`, in cells.
struct AxisFrame
{
    Real centre, width;
    Real per_spacing; // 1/mm
    Real spacing;     // mm
};

/// Add the interval [lower, upper] inside cell `cell` to nodes n and n + 1 of the axis.
void add_interval(const AxisFrame& frame, Real lower, Real upper, int cell, int n, BoxAxis& axis)
{
    const Real share = (upper - lower) / frame.width;
    const Real xi = Real(0.5) * (lower + upper) - static_cast<Real>(cell);
    axis.weight[n] += share * (1 - xi);
    axis.weight[n + 1] += share * xi;
    axis.slope[n] -= share * frame.per_spacing;
    axis.slope[n + 1] += share * frame.per_spacing;
    axis.arm[n] = (static_cast<Real>(cell) - frame.centre) * frame.spacing;
    axis.arm[n + 1] = (static_cast<Real>(cell + 1) - frame.centre) * frame.spacing;
    axis.count = n + 2;
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

/// The part of an axis that lies in one leaf.
struct Segment
{
    int first = 0, cells = 1; // on the level of the home leaf
    BoxAxis axis;
};

/// The one or two segments of a box that covers at most two cells along the axis.
struct Segments
{
    int count = 0;
    Segment at[2];
};

Segments segments_of(const AxisFrame& frame, Real lower, Real upper, int first, int last, bool single)
{
    Segments s;
    s.count = 1;
    s.at[0].first = first;
    if (first == last) {
        add_interval(frame, lower, upper, first, 0, s.at[0].axis);
        return s;
    }
    const Real plane = static_cast<Real>(last);
    add_interval(frame, lower, plane, first, 0, s.at[0].axis);
    if (!single && (first & 7) != 7) {
        s.at[0].cells = 2;
        add_interval(frame, plane, upper, last, 1, s.at[0].axis);
        return s;
    }
    s.count = 2;
    s.at[1].first = last;
    add_interval(frame, plane, upper, last, 0, s.at[1].axis);
    return s;
}

/// Everything about one particle while its box is cut the general way, from level 0 down.
struct GeneralCut
{
    const BoxCutter& cutter;
    BoxBounds bounds; // whole box, in finest cells
    Vec3 centre;      // of the particle, in finest cells
    int finest;
    std::array<bool, 3> reflected{}; // of the present piece
    std::array<int, 3> wall{};       // in finest cells
    BoxBounds piece;                 // reflected where `reflected`
    BoxParts& parts;

    void emit(int level, const Index3& cell) const
    {
        const std::int64_t slot = grid::active_slot(cutter.levels, level, cell);
        if (slot < 0) {
            parts.outside = true;
            return;
        }
        BoxPart part;
        part.leaf = static_cast<std::int32_t>(slot / grid::leaf_cells);
        part.cell = static_cast<std::int32_t>(slot % grid::leaf_cells);
        part.node = grid::tile_index(part.cell >> 6, part.cell >> 3 & 7, part.cell & 7);
        const Real scale = power_of_two(level - finest);
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            const Real spacing = cutter.levels.spacing(level);
            const AxisFrame frame{scale * centre[a], scale * (bounds.upper[a] - bounds.lower[a]), 1 / spacing, spacing};
            const Real lower = std::max(scale * piece.lower[a], static_cast<Real>(cell[a]));
            const Real upper = std::min(scale * piece.upper[a], static_cast<Real>(cell[a] + 1));
            add_interval(frame, lower, upper, cell[a], 0, part.axis[a]);
            if (!reflected[axis]) continue;
            reflect(frame, wall[axis] >> (finest - level), cell[a], part.axis[a]);
            part.reflected = true;
        }
        parts.part.push_back(part);
    }

    void descend(int level, const Index3& cell) const
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

    void pieces() const
    {
        const Real scale = power_of_two(-finest);
        const CellRange range = cells_between({scale * piece.lower, scale * piece.upper});
        for (int i = range.first[0]; i <= range.last[0]; ++i)
            for (int j = range.first[1]; j <= range.last[1]; ++j)
                for (int k = range.first[2]; k <= range.last[2]; ++k) descend(0, Index3(i, j, k));
    }

    /// The box in one to eight pieces, those beyond a wall reflected.
    void fold(int a)
    {
        if (a == 3) return pieces();
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

bool crosses_wall(const std::vector<grid::WallPlane>& walls, const BoxBounds& bounds, int level)
{
    for (const grid::WallPlane& plane : walls) {
        const int at = plane.node0 << level;
        if (bounds.lower[plane.axis] < at && bounds.upper[plane.axis] > at) return true;
    }
    return false;
}
} // namespace

Real box_half_width(const PassOptions& options, const particles::Particles& particles, std::size_t p, int level)
{
    return Real(0.5) / options.per_axis * power_of_two(level - particles.size_level[p]);
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

BoxBounds box_bounds(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                     std::size_t p, int level, Real margin)
{
    // The same rounding as in the kernels' test of the home cell (chunk.h, inside).
    const Real per_spacing = Real(1) / levels.spacing(level);
    const Vec3 centre =
        (Vec3(particles.position[0][p], particles.position[1][p], particles.position[2][p]) - levels.origin) *
        per_spacing;
    const Vec3 half = Vec3::Constant(box_half_width(options, particles, p, level) +
                                     margin * power_of_two(level - particles.size_level[p]));
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

BoxCutter::BoxCutter(const PassOptions& pass, const grid::Levels& all, const grid::Refinement& cells)
    : options(pass), levels(all), refinement(cells), hangs(all.leaves.size(), 0)
{
    if (pass.transfer != Transfer::apic) return;
    for (std::size_t n = 0; n < hangs.size(); ++n) {
        const HangingRange range = hanging_cells(all, n);
        hangs[n] = range.begin != range.end ? 1 : 0;
    }
}

bool BoxCutter::cut_at_home(const particles::Particles& particles, std::size_t p, std::size_t home, BoxPart& part) const
{
    if (hangs[home] != 0) return false;
    const grid::Leaf& leaf = levels.leaves[home];
    const Real spacing = levels.spacing0 * power_of_two(-leaf.level);
    const Real per_spacing = Real(1) / spacing;
    const Real half = box_half_width(options, particles, p, leaf.level);
    const Real to_finest = power_of_two(levels.count - 1 - leaf.level), from_finest = 1 / to_finest;
    int first[3];
    bool here = true;
    for (int a = 0; a < 3; ++a) {
        const Real centre = (particles.position[static_cast<std::size_t>(a)][p] - levels.origin[a]) * per_spacing;
        const Real lower = snap(centre - half, to_finest, from_finest);
        const Real upper = snap(centre + half, to_finest, from_finest);
        const Real cell = std::floor(lower);
        const Real plane = std::min(upper, cell + 1);
        const Real per_width = Real(1) / (upper - lower);
        const Real share0 = (plane - lower) * per_width, share1 = (upper - plane) * per_width;
        const Real xi0 = Real(0.5) * (lower + plane) - cell, xi1 = Real(0.5) * (plane + upper) - (cell + 1);
        BoxAxis& axis = part.axis[a];
        axis.count = upper > cell + 1 ? 3 : 2;
        axis.weight[0] = share0 * (1 - xi0);
        axis.weight[1] = share0 * xi0 + share1 * (1 - xi1);
        axis.weight[2] = share1 * xi1;
        axis.slope[0] = -share0 * per_spacing;
        axis.slope[1] = (share0 - share1) * per_spacing;
        axis.slope[2] = share1 * per_spacing;
        axis.arm[0] = (cell - centre) * spacing;
        axis.arm[1] = axis.arm[0] + spacing;
        axis.arm[2] = axis.arm[1] + spacing;
        axis.sign = 1;
        first[a] = static_cast<int>(cell) - leaf.origin[a];
        here = here && first[a] >= 0 && first[a] + axis.count <= grid::tile_side && upper <= cell + 2;
        for (const grid::WallPlane& plane_of : options.walls) {
            const Real at = static_cast<Real>(plane_of.node0 << leaf.level);
            here = here && !(plane_of.axis == a && lower < at && upper > at);
        }
    }
    if (!here) return false;
    const std::uint8_t* active =
        levels.cell_active.data() + home * grid::leaf_cells + grid::cell_index(first[0], first[1], first[2]);
    std::uint8_t all = 1;
    for (int i = 0; i < part.axis[0].count - 1; ++i)
        for (int j = 0; j < part.axis[1].count - 1; ++j)
            for (int k = 0; k < part.axis[2].count - 1; ++k)
                all = static_cast<std::uint8_t>(all & active[grid::cell_index(i, j, k)]);
    if (all == 0) return false;
    part.leaf = static_cast<std::int32_t>(home);
    part.node = grid::tile_index(first[0], first[1], first[2]);
    part.cell = -1;
    part.reflected = false;
    return true;
}

void BoxCutter::cut(const particles::Particles& particles, std::size_t p, std::size_t home, BoxParts& parts) const
{
    parts.part.resize(1);
    parts.outside = false;
    if (cut_at_home(particles, p, home, parts.part[0])) return;
    parts.part.clear();
    const int level = levels.leaves[home].level;
    const BoxBounds bounds = box_bounds(options, levels, particles, p, level);
    const Real spacing = levels.spacing(level);
    const Real per_spacing = Real(1) / spacing;
    const Vec3 centre =
        (Vec3(particles.position[0][p], particles.position[1][p], particles.position[2][p]) - levels.origin) *
        per_spacing;
    const CellRange range = cells_between(bounds);
    bool uniform = (range.last - range.first).maxCoeff() <= 1 && !crosses_wall(options.walls, bounds, level);
    if (uniform) {
        Segments segments[3];
        for (int a = 0; a < 3; ++a)
            segments[a] = segments_of({centre[a], bounds.upper[a] - bounds.lower[a], per_spacing, spacing},
                                      bounds.lower[a], bounds.upper[a], range.first[a], range.last[a], false);
        const auto build = [&] {
            for (int i = 0; i < segments[0].count; ++i)
                for (int j = 0; j < segments[1].count; ++j)
                    for (int k = 0; k < segments[2].count; ++k) {
                        const Segment* s[3] = {&segments[0].at[i], &segments[1].at[j], &segments[2].at[k]};
                        const Index3 first(s[0]->first, s[1]->first, s[2]->first);
                        const CellPlace at = place_near(levels, home, first);
                        for (int x = 0; x < s[0]->cells; ++x)
                            for (int y = 0; y < s[1]->cells; ++y)
                                for (int z = 0; z < s[2]->cells; ++z)
                                    if (!is_active(levels, {at.leaf, at.cell + grid::cell_index(x, y, z)}))
                                        return false;
                        BoxPart part;
                        part.leaf = at.leaf;
                        part.node = grid::tile_index(at.cell >> 6, at.cell >> 3 & 7, at.cell & 7);
                        part.cell = s[0]->cells * s[1]->cells * s[2]->cells == 1 ? at.cell : -1;
                        for (int a = 0; a < 3; ++a) part.axis[a] = s[a]->axis;
                        parts.part.push_back(part);
                    }
            return true;
        };
        uniform = build();
        const auto split = [&] {
            for (const BoxPart& part : parts.part)
                if (part.cell < 0 && hangs[static_cast<std::size_t>(part.leaf)] != 0) return true;
            return false;
        };
        if (uniform && split()) {
            parts.part.clear();
            for (int a = 0; a < 3; ++a)
                segments[a] = segments_of({centre[a], bounds.upper[a] - bounds.lower[a], per_spacing, spacing},
                                          bounds.lower[a], bounds.upper[a], range.first[a], range.last[a], true);
            build();
        }
    }
    if (uniform) return;
    parts.part.clear();
    const int finest = levels.count - 1;
    const Real scale = power_of_two(finest - level);
    const BoxBounds whole{scale * bounds.lower, scale * bounds.upper};
    GeneralCut general{*this, whole, scale * centre, finest, {}, {}, whole, parts};
    general.fold(0);
}
} // namespace transfer
