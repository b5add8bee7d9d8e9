/// Weights of boxes in closed form, lanes = particles: for boxes that lie in cells of their leaf's level.
///
/// Along an axis, in cells, a box [L, U] of width W that begins in cell c is cut by at most one plane P = min(U, c + 1)
/// into f0 = P - L and f1 = U - P. Mean and slope of the hat functions of the nodes c, c + 1, c + 2 over it are
///
///     w2 = f1 / W * f1 / 2,    w0 = f0 / W * (1 - (L + P) / 2 + c),    w1 = 1 - w0 - w2
///     s2 = f1 / (W h),         s0 = -f0 / (W h),                       s1 = -s0 - s2
///
/// (f0 / W as 1 - f1 / W, so that weights add up to one whatever rounding did to the width). This is the sub-box rule
/// of gimp_box.h with one cut per axis (methods.md A.3.3), so both agree to round-off.
#pragma once

#include "transfer/chunk.h"
#include "transfer/gimp_box.h"
#include "transfer/gimp_reach.h"

namespace transfer
{
/// Where the boxes of one leaf lie and how wide they are.
struct BoxFrame
{
    Vec3 origin;               // mm, of the lattice
    std::array<Real, 3> lower; // 1, index of the leaf's lower corner
    Real spacing, per_spacing; // mm, 1/mm
    Real to_finest, from_finest;
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
    frame.to_finest = static_cast<Real>(1 << (levels.count - 1 - home.level));
    frame.from_finest = Real(1) / frame.to_finest;
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

/// Does the map serve box i, so that its weights count?
inline bool served(const ReachMap& map, const BoxWeights& weights, int i)
{
    return (map.serves[weights.node(i)] >> weights.code(i) & 1) != 0;
}

namespace detail
{
/// The nearest whole number: from 2^52 on a double has no places after the point.
[[gnu::always_inline]] inline Lanes nearest(Lanes x)
{
    const Lanes shift(Real(6755399441055744)); // 1.5 * 2^52
    return (x + shift) - shift;
}

[[gnu::always_inline]] inline Lanes floor(Lanes x)
{
    const Lanes near = nearest(x);
    return near - core::select(near > x, Lanes(Real(1)), Lanes(Real(0)));
}

/// The rounding of gimp_box.h: on a plane of the finest cells if x lies there but for rounding.
[[gnu::always_inline]] inline Lanes snap(const BoxFrame& frame, Lanes x)
{
    const Lanes fine = x * Lanes(frame.to_finest);
    const Lanes near = nearest(fine);
    const Lanes off = fine - near;
    return core::select(core::max(off, -off) < Lanes(box_on_plane), near * Lanes(frame.from_finest), x);
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

/// Weights of the particles [begin, begin + count); boxes that reach too far get a place that no map serves.
/// @tparam Arms  also the arms (APIC)
template <bool Arms>
[[gnu::always_inline]] inline void box_weights(const BoxFrame& frame, const particles::Particles& particles,
                                               std::size_t begin, int count, BoxWeights& weights)
{
    const Lanes one(Real(1)), zero(Real(0)), middle(Real(0.5));
    const auto [half, per_width] = detail::widths_of(frame, particles.size_level.data() + begin, count);
    const Lanes per_spacing(frame.per_spacing), spacing(frame.spacing);
    Lanes place = zero, code = zero;
    LaneMask near = one > zero;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const Lanes centre =
            (load(particles.position[axis], begin, count) - Lanes(frame.origin[a])) * Lanes(frame.per_spacing);
        const Lanes lower = detail::snap(frame, centre - half), upper = detail::snap(frame, centre + half);
        const Lanes cell = detail::floor(lower);
        const Lanes plane = core::min(upper, cell + one);
        const Lanes f1 = upper - plane;
        const Lanes share1 = f1 * per_width, share0 = one - share1;
        const Lanes w0 = share0 * (one - (middle * (lower + plane) - cell)), w2 = share1 * (middle * f1);
        w0.store(weights.weight[a][0]);
        (one - w0 - w2).store(weights.weight[a][1]);
        w2.store(weights.weight[a][2]);
        const Lanes s0 = -share0 * per_spacing, s2 = share1 * per_spacing;
        s0.store(weights.slope[a][0]);
        (-s0 - s2).store(weights.slope[a][1]);
        s2.store(weights.slope[a][2]);
        if constexpr (Arms) {
            const Lanes arm = (cell - centre) * spacing;
            arm.store(weights.arm[a][0]);
            (arm + spacing).store(weights.arm[a][1]);
            (arm + spacing + spacing).store(weights.arm[a][2]);
        }
        const Lanes local = cell - Lanes(frame.lower[axis]);
        near = near & (local >= -one) & (local <= Lanes(Real(grid::leaf_side))) & (f1 <= one);
        place = place * Lanes(Real(reach_side)) + (local + one);
        code = code + code + core::select(f1 > zero, one, zero);
    }
    static_assert(reach_index(1, 2, 3) == (2 * reach_side + 3) * reach_side + 4);
    const Lanes nowhere(Real(8 * (reach_nodes - 1))); // the place of a cell beyond the tile
    const Lanes where = core::select(near, Lanes(Real(8)) * place + code, nowhere);
    using Integers = core::VectorOf<std::int32_t, Lanes::lanes>;
    *reinterpret_cast<Integers::unaligned*>(weights.place) = __builtin_convertvector(where.v, Integers::type);
}
} // namespace transfer
