/// Weights of boxes in closed form, lanes = particles: for boxes that lie in cells of their leaf's level.
///
/// Along an axis, in cells, a box [L, U] of width W that begins in cell c is cut by at most one plane P = min(U, c + 1)
/// into f0 = P - L and f1 = U - P. Mean and slope of the hat functions of the nodes c, c + 1, c + 2 over it are
///
///     w2 = f1 / W * f1 / 2,    w0 = f0 / W * (1 - (L + P) / 2 + c),    w1 = 1 - w0 - w2
///     s2 = f1 / (W h),         s0 = -f0 / (W h),                       s1 = -s0 - s2
///
/// (f0 / W as 1 - f1 / W, so that weights add up to one whatever rounding did to the width). This is the sub-box rule
/// of gimp_box.h with one cut per axis (methods.md A.3.3), so both agree to round-off. As there a bound that lies on a
/// plane but for rounding is on it: L may lie below c, and U above P, by that much, where the formulas still hold.
#pragma once

#include "transfer/chunk.h"
#include "transfer/gimp_box.h"
#include "transfer/gimp_reach.h"

namespace transfer
{
/// Where the boxes of one leaf lie and how wide they are.
struct BoxFrame
{
    Vec3 origin;                         // mm, of the lattice
    std::array<Real, 3> lower;           // 1, index of the leaf's lower corner
    Real spacing, per_spacing;           // mm, 1/mm
    Real on_plane;                       // 1, bounds nearer to a plane than this are on it
    std::array<Real, 8> half, per_width; // [size level] in cells of the leaf; there are at most 8 levels
};

inline BoxFrame box_frame(const PassOptions& options, const grid::Levels& levels, std::size_t leaf)
{
    const grid::Leaf& home = levels.leaves[leaf];
    BoxFrame frame;
    frame.origin = levels.origin;
    frame.spacing = levels.spacing(home.level);
    frame.per_spacing = Real(1) / frame.spacing;
    for (std::size_t a = 0; a < 3; ++a) frame.lower[a] = home.origin[static_cast<int>(a)];
    frame.on_plane = box_on_plane / static_cast<Real>(1 << (levels.count - 1 - home.level));
    for (std::size_t size = 0; size < 8; ++size) {
        frame.half[size] = box_half_width(options, static_cast<int>(size), home.level);
        frame.per_width[size] = Real(0.5) / frame.half[size];
    }
    return frame;
}

/// Weights of a chunk of boxes, one array entry per particle.
struct BoxWeights
{
    static constexpr int lanes = Lanes::lanes;
    alignas(64) Real weight[3][3][lanes];  // [axis][node]
    alignas(64) Real slope[3][3][lanes];   // 1/mm
    alignas(64) Real arm[3][3][lanes];     // mm, node minus particle
    alignas(64) std::int32_t place[lanes]; // 8 * reach_index of the lowest node + code of the axes with three nodes

    int node(int i) const { return place[i] >> 3; }
    int code(int i) const { return place[i] & 7; }
};

/// Does the map serve a box of this BoxWeights::place, so that its weights count?
inline bool served(const ReachMap& map, std::int32_t place)
{
    return (map.serves[place >> 3] >> (place & 7) & 1) != 0;
}
inline bool served(const ReachMap& map, const BoxWeights& weights, int i)
{
    return served(map, weights.place[i]);
}

namespace detail
{
/// The nearest whole number: from 2^52 on a double has no places after the point.
[[gnu::always_inline]] inline Lanes nearest(Lanes x)
{
    const Lanes shift(Real(6755399441055744)); // 1.5 * 2^52
    return (x + shift) - shift;
}

/// Half widths [cells] and one over the widths.
struct Widths
{
    Lanes half, per_width;
};

[[gnu::noinline]] inline void mix_widths(const BoxFrame& frame, const std::uint8_t* size, int count, Widths& widths)
{
    for (int i = 1; i < count; ++i) {
        widths.half.v[i] = frame.half[size[i]];
        widths.per_width.v[i] = frame.per_width[size[i]];
    }
}

[[gnu::always_inline]] inline Widths widths_of(const BoxFrame& frame, const std::uint8_t* size, int count)
{
    Widths widths{Lanes(frame.half[size[0]]), Lanes(frame.per_width[size[0]])};
    if (!all_equal(size, count)) mix_widths(frame, size, count, widths);
    return widths;
}
} // namespace detail

/// One axis of a chunk of boxes, in cells of their leaf. The node c + 1 has what the weights lack to 1, the slopes to
/// 0.
struct AxisLanes
{
    Lanes cell;             // c, on the lattice
    Lanes centre;           // of the box
    Lanes beyond;           // f1
    Lanes weight0, weight2; // of the nodes c and c + 2
    Lanes slope0, slope2;   // 1/mm
};
using BoxAxes = std::array<AxisLanes, 3>;

/// Where the boxes of the particles [begin, begin + count) lie.
[[gnu::always_inline]] inline BoxAxes box_axes(const BoxFrame& frame, const particles::Particles& particles,
                                               std::size_t begin, int count)
{
    const Lanes one(Real(1)), middle(Real(0.5));
    const auto [half, per_width] = detail::widths_of(frame, particles.size_level.data() + begin, count);
    const Lanes per_spacing(frame.per_spacing), on_plane(frame.on_plane);
    BoxAxes axes;
    for (std::size_t a = 0; a < 3; ++a) {
        AxisLanes& axis = axes[a];
        axis.centre = (load(particles.position[a], begin, count) - Lanes(frame.origin[static_cast<int>(a)])) *
                      Lanes(frame.per_spacing);
        const Lanes lower = axis.centre - half, upper = axis.centre + half;
        axis.cell = detail::nearest(lower + on_plane - middle); // the cell of lower + on_plane
        const Lanes next = axis.cell + one;
        const LaneMask reaches = upper > next + on_plane;
        axis.beyond = core::select(reaches, upper - next, Lanes(Real(0)));
        const Lanes plane = core::select(reaches, next, upper);
        const Lanes share1 = axis.beyond * per_width, share0 = one - share1;
        axis.weight0 = share0 * (one - (middle * (lower + plane) - axis.cell));
        axis.weight2 = share1 * (middle * axis.beyond);
        axis.slope0 = -share0 * per_spacing;
        axis.slope2 = share1 * per_spacing;
    }
    return axes;
}

/// 8 * reach_index of every box's lowest node + its code; boxes that reach too far get a place that no map serves.
[[gnu::always_inline]] inline void store_places(const BoxFrame& frame, const BoxAxes& axes,
                                                std::int32_t (&places)[Lanes::lanes])
{
    const Lanes one(Real(1)), zero(Real(0));
    Lanes place = zero, code = zero;
    LaneMask near = one > zero;
    for (std::size_t a = 0; a < 3; ++a) {
        const Lanes local = axes[a].cell - Lanes(frame.lower[a]);
        near = near & (local >= -one) & (local <= Lanes(Real(grid::leaf_side))) & (axes[a].beyond <= one);
        place = place * Lanes(Real(reach_side)) + (local + one);
        code = code + code + core::select(axes[a].beyond > zero, one, zero);
    }
    static_assert(reach_index(1, 2, 3) == (2 * reach_side + 3) * reach_side + 4);
    const Lanes nowhere(Real(8 * (reach_nodes - 1))); // the place of a cell beyond the tile
    const Lanes where = core::select(near, Lanes(Real(8)) * place + code, nowhere);
    using Integers = core::VectorOf<std::int32_t, Lanes::lanes>;
    *reinterpret_cast<Integers::unaligned*>(places) = __builtin_convertvector(where.v, Integers::type);
}

/// The weights of every box for itself.
/// @tparam Arms  also the arms (APIC)
template <bool Arms>
[[gnu::always_inline]] inline void box_weights(const BoxFrame& frame, const BoxAxes& axes, BoxWeights& weights)
{
    const Lanes one(Real(1)), spacing(frame.spacing);
    for (std::size_t a = 0; a < 3; ++a) {
        const AxisLanes& axis = axes[a];
        axis.weight0.store(weights.weight[a][0]);
        (one - axis.weight0 - axis.weight2).store(weights.weight[a][1]);
        axis.weight2.store(weights.weight[a][2]);
        axis.slope0.store(weights.slope[a][0]);
        (-axis.slope0 - axis.slope2).store(weights.slope[a][1]);
        axis.slope2.store(weights.slope[a][2]);
        if constexpr (Arms) {
            const Lanes arm = (axis.cell - axis.centre) * spacing;
            arm.store(weights.arm[a][0]);
            (arm + spacing).store(weights.arm[a][1]);
            (arm + spacing + spacing).store(weights.arm[a][2]);
        }
    }
    store_places(frame, axes, weights.place);
}
} // namespace transfer
