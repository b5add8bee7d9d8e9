/// Trilinear slopes at the eight points of a reference lattice, and the adjoint, as tensor products.
///
/// The points of a cell, its slots, sit at 1/4 and 3/4 of the edge along each axis; slot 4a + 2b + c and corner 4i + 2j
/// + k count alike, x outermost. The slope along an axis does not change along that axis: four values serve the eight
/// slots, `slope_place` names them. A component costs 46 additions and multiplications for all slots, and so does the
/// adjoint. V is a number or a core::Pack of cells (one cell per lane).
#pragma once

#include "core/simd.h"
#include "core/tensor.h"

namespace transfer
{
inline constexpr int slots = 8; // points per cell

/// Which of the four slopes along `axis` belongs to a slot.
constexpr int slope_place(int axis, int slot)
{
    return axis == 0 ? slot & 3 : axis == 1 ? (slot >> 1 & 2) | (slot & 1) : slot >> 1;
}

/// Slopes of one component: [axis][slope_place].
template <class V>
struct Slopes
{
    V along[3][4];
};

namespace detail
{
/// Values at 1/4 and 3/4 between two values that differ by `difference` = upper - lower.
template <class V>
[[gnu::always_inline]] inline void inner(const V& lower, const V& upper, const V& difference, V& at_first, V& at_second)
{
    const V quarter(Real(0.25));
    at_first = lower + quarter * difference;
    at_second = upper - quarter * difference;
}

template <class V>
[[gnu::always_inline]] inline void inner(const V& lower, const V& upper, V& at_first, V& at_second)
{
    inner(lower, upper, upper - lower, at_first, at_second);
}
} // namespace detail

/// Differences upper - lower of a trilinear field (divide by the spacing for the gradient) at the slots.
/// @param corner  values at the corners
template <class V>
[[gnu::always_inline]] inline Slopes<V> slopes_at_slots(const V (&corner)[8])
{
    using detail::inner;
    Slopes<V> s;
    V along_x[4], at_x[2][4];
    for (int jk = 0; jk < 4; ++jk) {
        along_x[jk] = corner[4 + jk] - corner[jk];
        inner(corner[jk], corner[4 + jk], along_x[jk], at_x[0][jk], at_x[1][jk]);
    }
    V half[2][2]; // [b][k]
    for (int k = 0; k < 2; ++k) inner(along_x[k], along_x[2 + k], half[0][k], half[1][k]);
    for (int b = 0; b < 2; ++b) inner(half[b][0], half[b][1], s.along[0][2 * b], s.along[0][2 * b + 1]);
    for (int a = 0; a < 2; ++a) {
        V along_y[2], at_y[2][2];
        for (int k = 0; k < 2; ++k) {
            along_y[k] = at_x[a][2 + k] - at_x[a][k];
            inner(at_x[a][k], at_x[a][2 + k], along_y[k], at_y[0][k], at_y[1][k]);
        }
        inner(along_y[0], along_y[1], s.along[1][2 * a], s.along[1][2 * a + 1]);
        for (int b = 0; b < 2; ++b) s.along[2][2 * a + b] = at_y[b][1] - at_y[b][0];
    }
    return s;
}

/// The adjoint: corner values sum over slots and axes of flux(axis, slot) d(slope)/d(corner), with the fluxes of the
/// slots that share a slope already added.
template <class V>
[[gnu::always_inline]] inline void slopes_to_corners(const Slopes<V>& flux, V (&corner)[8])
{
    using detail::inner;
    // inner() is its own adjoint: the weights 3/4 and 1/4 form a symmetric matrix.
    V half[2][2]; // [b][k]
    V along_x[4];
    for (int b = 0; b < 2; ++b) inner(flux.along[0][2 * b], flux.along[0][2 * b + 1], half[b][0], half[b][1]);
    for (int k = 0; k < 2; ++k) inner(half[0][k], half[1][k], along_x[k], along_x[2 + k]);
    V at_x[2][4];
    for (int a = 0; a < 2; ++a) {
        V along_y[2], at_y[2][2];
        inner(flux.along[1][2 * a], flux.along[1][2 * a + 1], along_y[0], along_y[1]);
        for (int b = 0; b < 2; ++b) {
            at_y[b][0] = -flux.along[2][2 * a + b];
            at_y[b][1] = flux.along[2][2 * a + b];
        }
        for (int k = 0; k < 2; ++k) {
            inner(at_y[0][k], at_y[1][k], at_x[a][k], at_x[a][2 + k]);
            at_x[a][k] -= along_y[k];
            at_x[a][2 + k] += along_y[k];
        }
    }
    for (int jk = 0; jk < 4; ++jk) {
        inner(at_x[0][jk], at_x[1][jk], corner[jk], corner[4 + jk]);
        corner[jk] -= along_x[jk];
        corner[4 + jk] += along_x[jk];
    }
}

/// F = I + slopes / spacing at a slot.
template <class V>
[[gnu::always_inline]] inline core::Mat<V> deformation_at(const Slopes<V> (&displacement)[3], int slot,
                                                          Real per_spacing)
{
    core::Mat<V> f;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            f(a, b) = V(a == b ? 1 : 0) + V(per_spacing) * displacement[a].along[b][slope_place(b, slot)];
    return f;
}
} // namespace transfer
