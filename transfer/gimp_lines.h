/// Sums over the nodes of one part of a box; lanes are the eight quantities of a node (one cache line), factorised z,
/// y, x.
///
/// With w the weight, s the slope and d = x_i - x_p of an axis, a node line N and the coefficient of axis a in lane q
/// either s or w d, both directions are
///
///     gather:   value = sum w w w N,   along_a = sum (coefficient of a) w w N
///     scatter:  N += w w w base + sum_a (coefficient of a) w w slope_a
#pragma once

#include "core/simd.h"
#include "transfer/gimp_box.h"

namespace transfer
{
/// One lane per quantity of a node.
using NodeLine = core::Pack<Real, 8>;

namespace detail
{
inline constexpr NodeLine::Lanes lower_half = {1, 1, 1, 1, 0, 0, 0, 0};
inline constexpr NodeLine::Lanes upper_half = {0, 0, 0, 0, 1, 1, 1, 1};
inline constexpr NodeLine::Lanes momentum_lanes = {0, 1, 1, 1, 0, 0, 0, 0};
inline constexpr NodeLine::Lanes force_lanes = {0, 0, 0, 0, 1, 1, 1, 0};

[[gnu::always_inline]] inline NodeLine doubled(NodeLine line)
{
    return {__builtin_shufflevector(line.v, line.v, 0, 1, 2, 3, 0, 1, 2, 3)};
}

/// +1, or -1 in the lanes of axes that are reflected; `first` is the lane of the x component.
[[gnu::always_inline]] inline NodeLine signs(const BoxPart& part, int first)
{
    NodeLine line(Real(1));
    for (int a = 0; a < 3; ++a) {
        line.v[first + a] = part.axis[a].sign;
        line.v[4 + a] = part.axis[a].sign;
    }
    return line;
}
} // namespace detail

/// What a box reads off the grid.
struct BoxSample
{
    NodeLine value;    // lanes of grid::NodeMotion
    NodeLine along[3]; // without moments: slopes of all lanes [1/mm]; with: 0-2 slopes of the velocity, 4-6 its first
                       // moments sum w (x_i - x_p) v [mm^2/ms]
};

[[gnu::always_inline]] inline void clear(BoxSample& sample)
{
    const NodeLine zero(Real(0));
    sample.value = sample.along[0] = sample.along[1] = sample.along[2] = zero;
}

/// Add the part of a box; `tile` is the motion tile of its leaf.
template <bool Moments>
void gather_part(const BoxPart& part, const grid::NodeMotion* tile, BoxSample& sample)
{
    const NodeLine lower(detail::lower_half), upper(detail::upper_half), zero(Real(0));
    NodeLine coefficient[3][3];
    for (int a = 0; a < 3; ++a)
        for (int n = 0; n < 3; ++n) {
            const BoxAxis& axis = part.axis[a];
            coefficient[a][n] = Moments
                                    ? lower * NodeLine(axis.slope[n]) + upper * NodeLine(axis.weight[n] * axis.arm[n])
                                    : NodeLine(axis.slope[n]);
        }
    const grid::NodeMotion* node = tile + part.node;
    NodeLine v = zero, x = zero, y = zero, z = zero;
    for (int i = 0; i < part.axis[0].count; ++i) {
        NodeLine v_i = zero, y_i = zero, z_i = zero;
        for (int j = 0; j < part.axis[1].count; ++j) {
            NodeLine v_j = zero, z_j = zero;
            for (int k = 0; k < part.axis[2].count; ++k) {
                NodeLine line = NodeLine::load(node[grid::tile_index(i, j, k)].velocity.data());
                if constexpr (Moments) line = detail::doubled(line);
                v_j += NodeLine(part.axis[2].weight[k]) * line;
                z_j += coefficient[2][k] * line;
            }
            const NodeLine w(part.axis[1].weight[j]);
            v_i += w * v_j;
            y_i += coefficient[1][j] * v_j;
            z_i += w * z_j;
        }
        const NodeLine w(part.axis[0].weight[i]);
        v += w * v_i;
        x += coefficient[0][i] * v_i;
        y += w * y_i;
        z += w * z_i;
    }
    if (part.reflected) {
        const NodeLine sign = detail::signs(part, 0);
        v *= sign;
        x *= sign;
        y *= sign;
        z *= sign;
    }
    sample.value += v;
    sample.along[0] += x;
    sample.along[1] += y;
    sample.along[2] += z;
}

/// What a particle gives to every node it reaches, in lanes of grid::NodeSum.
struct BoxLines
{
    NodeLine base;     // mass, momentum
    NodeLine slope[3]; // [b] lanes 1 + a: m C(a, b) [g/ms]; lanes 4 + a: V sigma(a, b) [N mm]
};

/// Add the part of a box to the sum tile of its leaf: mass, momentum with its affine part, force - V sigma grad w.
inline void scatter_part(const BoxPart& part, const BoxLines& from, grid::NodeSum* tile)
{
    BoxLines lines = from;
    if (part.reflected) {
        const NodeLine sign = detail::signs(part, 1);
        lines.base *= sign;
        for (NodeLine& slope : lines.slope) slope *= sign;
    }
    const NodeLine momentum(detail::momentum_lanes), force(detail::force_lanes);
    NodeLine coefficient[3][3];
    for (int a = 0; a < 3; ++a)
        for (int n = 0; n < 3; ++n) {
            const BoxAxis& axis = part.axis[a];
            coefficient[a][n] = momentum * NodeLine(axis.weight[n] * axis.arm[n]) - force * NodeLine(axis.slope[n]);
        }
    grid::NodeSum* node = tile + part.node;
    for (int i = 0; i < part.axis[0].count; ++i) {
        const NodeLine w_i(part.axis[0].weight[i]);
        const NodeLine base_i = w_i * lines.base + coefficient[0][i] * lines.slope[0];
        const NodeLine y_i = w_i * lines.slope[1], z_i = w_i * lines.slope[2];
        for (int j = 0; j < part.axis[1].count; ++j) {
            const NodeLine w_j(part.axis[1].weight[j]);
            const NodeLine base_j = w_j * base_i + coefficient[1][j] * y_i;
            const NodeLine z_j = w_j * z_i;
            for (int k = 0; k < part.axis[2].count; ++k) {
                Real* target = &node[grid::tile_index(i, j, k)].mass;
                const NodeLine line = NodeLine(part.axis[2].weight[k]) * base_j + coefficient[2][k] * z_j;
                (NodeLine::load(target) + line).store(target);
            }
        }
    }
}
} // namespace transfer
