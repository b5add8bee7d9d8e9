/// Sums over the nodes of a box; lanes are the eight quantities of a node (one cache line), factorised z, y, x.
///
/// With w the weight, s the slope and d = x_i - x_p of an axis, a node line N and the coefficient of axis a in lane q
/// either s or w d, both directions are
///
///     gather:   value = sum w w w N,   along_a = sum (coefficient of a) w w N
///     scatter:  N += w w w base + sum_a (coefficient of a) w w slope_a
///
/// A whole box has two or three nodes per axis and weights from a BoxWeights; a part of a cut one has two.
#pragma once

#include "transfer/gimp_shared.h"
#include "transfer/line_lanes.h"
#include "transfer/node_line.h"

namespace transfer
{
/// Lines that a box reads: the values, then
///     slopes:  along x (of all lanes), and along y in the lower, along z in the upper half
///     affine:  one for each axis, slopes in the lower half, first moments sum w (x_i - x_p) v in the upper one
inline constexpr int box_lines(BoxRead read)
{
    return read == BoxRead::values ? 1 : read == BoxRead::affine ? 4 : 3;
}

namespace detail
{
alignas(64) inline constexpr Real momentum_lanes[8] = {0, 1, 1, 1, 0, 0, 0, 0};
alignas(64) inline constexpr Real force_lanes[8] = {0, 0, 0, 0, 1, 1, 1, 0};

/// The half of a line that slopes or moments are wanted of, twice.
template <BoxRead Read>
[[gnu::always_inline]] inline NodeLine wanted_half(NodeLine line)
{
    return Read == BoxRead::change_slopes ? upper_halves(line, line) : lower_halves(line, line);
}

/// +1, or -1 in the lanes of axes that are reflected; `first` is the lane of the x component.
inline NodeLine signs(const BoxPart& part, int first)
{
    Real sign[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    for (int a = 0; a < 3; ++a) sign[first + a] = sign[4 + a] = part.axis[a].sign;
    return NodeLine::load(sign);
}

/// Coefficient of slopes and moments.
[[gnu::always_inline]] inline NodeLine slope_and_moment(const BoxWeights& w, int axis, int n, int i)
{
    return halves(NodeLine(w.slope[axis][n][i]), NodeLine(w.weight[axis][n][i] * w.arm[axis][n][i]));
}

/// The slope in the lanes of the force, and for APIC weight times arm in those of the momentum. Without APIC the
/// momentum lanes of the slopes are zero.
template <bool Affine>
[[gnu::always_inline]] inline NodeLine scatter_coefficient(const BoxWeights& w, int axis, int n, int i)
{
    const NodeLine force(w.slope[axis][n][i]);
    return Affine ? halves(NodeLine(w.weight[axis][n][i] * w.arm[axis][n][i]), force) : force;
}
} // namespace detail

/// Read box i; `node` is its lowest one in the reach tile. Line n goes to out[n].
///
/// A function of its own for every number of nodes: inlined side by side their common parts would be computed before
/// the choice, and spilled.
template <BoxRead Read, int X, int Y, int Z>
[[gnu::noinline]] void gather_box(const BoxWeights& w, int i, const grid::NodeMotion* node, NodeLine* out)
{
    using detail::halves;
    constexpr bool values = Read == BoxRead::values, affine = Read == BoxRead::affine;
    const NodeLine zero(Real(0));
    Lanes z_weight[Z], y_weight[Y];
    NodeLine z_both[Z], y_both[Y];
    for (int k = 0; k < Z; ++k) {
        z_weight[k] = Lanes(w.weight[2][k][i]);
        if constexpr (affine) z_both[k] = detail::slope_and_moment(w, 2, k, i);
        if constexpr (!affine && !values) z_both[k] = halves(NodeLine(z_weight[k]), NodeLine(w.slope[2][k][i]));
    }
    for (int j = 0; j < Y; ++j) {
        y_weight[j] = Lanes(w.weight[1][j][i]);
        if constexpr (affine) y_both[j] = detail::slope_and_moment(w, 1, j, i);
        if constexpr (!affine && !values) y_both[j] = halves(NodeLine(w.slope[1][j][i]), NodeLine(y_weight[j]));
    }
    // Of the slopes: `yz` holds value and slope along z of the wanted half, then slopes along y and z.
    NodeLine value = zero, x = zero, y = zero, yz = zero;
    for (int a = 0; a < X; ++a) {
        NodeLine value_a = zero, y_a = zero, yz_a = zero;
        for (int b = 0; b < Y; ++b) {
            NodeLine value_b = zero, yz_b = zero;
            for (int c = 0; c < Z; ++c) {
                NodeLine line = NodeLine::load(node[(a * reach_side + b) * reach_side + c].velocity.data());
                const NodeLine twice = detail::wanted_half<Read>(line);
                if constexpr (affine) line = twice;
                value_b += z_weight[c] * line;
                if constexpr (!values) yz_b += z_both[c] * twice;
            }
            value_a += y_weight[b] * value_b;
            if constexpr (affine) {
                y_a += y_both[b] * value_b;
                yz_a += y_weight[b] * yz_b;
            } else if constexpr (!values) {
                yz_a += y_both[b] * yz_b;
            }
        }
        const Lanes x_weight(w.weight[0][a][i]);
        value += x_weight * value_a;
        if constexpr (affine) x += detail::slope_and_moment(w, 0, a, i) * value_a;
        if constexpr (!affine && !values) x += Lanes(w.slope[0][a][i]) * value_a;
        if constexpr (affine) y += x_weight * y_a;
        if constexpr (!values) yz += x_weight * yz_a;
    }
    out[0] = value;
    if constexpr (!values) out[1] = x;
    if constexpr (affine) {
        out[2] = y;
        out[3] = yz;
    } else if constexpr (!values) {
        out[2] = yz;
    }
}

/// The walks by BoxWeights::code.
template <BoxRead Read>
inline constexpr std::array gather_walks{
    gather_box<Read, 2, 2, 2>, gather_box<Read, 2, 2, 3>, gather_box<Read, 2, 3, 2>, gather_box<Read, 2, 3, 3>,
    gather_box<Read, 3, 2, 2>, gather_box<Read, 3, 2, 3>, gather_box<Read, 3, 3, 2>, gather_box<Read, 3, 3, 3>};

/// Add what the part of a cut box reads; `tile` is the motion tile of its leaf. Line n is
/// added to out[n].
template <BoxRead Read>
void gather_part(const BoxPart& part, const grid::NodeMotion* tile, NodeLine* out)
{
    constexpr bool affine = Read == BoxRead::affine;
    const NodeLine zero(Real(0));
    NodeLine sum[4] = {zero, zero, zero, zero}; // value, along x, y, z
    for (int corner = 0; corner < 8; ++corner) {
        const int n[3] = {corner >> 2, corner >> 1 & 1, corner & 1};
        NodeLine line = NodeLine::load(tile[part.node + grid::tile_index(n[0], n[1], n[2])].velocity.data());
        if constexpr (affine) line = detail::wanted_half<Read>(line);
        const Real w[3] = {part.axis[0].weight[n[0]], part.axis[1].weight[n[1]], part.axis[2].weight[n[2]]};
        sum[0] += Lanes(w[0] * w[1] * w[2]) * line;
        for (int a = 0; a < 3; ++a) {
            const Real across = w[(a + 1) % 3] * w[(a + 2) % 3];
            const NodeLine slope(across * part.axis[a].slope[n[a]]);
            const NodeLine moment(across * w[a] * part.axis[a].arm[n[a]]);
            sum[1 + a] += (affine ? detail::halves(slope, moment) : slope) * line;
        }
    }
    if (part.reflected)
        for (NodeLine& line : sum) line *= detail::signs(part, 0);
    out[0] += sum[0];
    if constexpr (Read == BoxRead::values) return;
    out[1] += sum[1];
    if constexpr (affine) {
        out[2] += sum[2];
        out[3] += sum[3];
    } else {
        out[2] += Read == BoxRead::change_slopes ? detail::upper_halves(sum[2], sum[3])
                                                 : detail::lower_halves(sum[2], sum[3]);
    }
}

/// What a particle gives to every node it reaches, as BoxGift; without APIC the slope along x lies in the upper half of
/// `base`, and slope[0] is not used.
struct GiftLines
{
    NodeLine base, slope[3];
};

/// Lines a gift is stored in: all four, or the base and one with the slopes along y and z in its halves.
inline constexpr int gift_lines(bool affine)
{
    return affine ? 4 : 2;
}

namespace detail
{
template <bool Affine>
[[gnu::always_inline]] inline GiftLines unfolded(const NodeLine* line)
{
    if constexpr (Affine) return {line[0], {line[1], line[2], line[3]}};
    const NodeLine zero(Real(0));
    return {line[0], {zero, lower_halves(zero, line[1]), halves(zero, line[1])}};
}
} // namespace detail

/// Add box i, whose gift is stored in `line`, to the sums in reach; `node` is its lowest one.
template <bool Affine, BoxGive Give, int X, int Y, int Z>
[[gnu::noinline]] void scatter_box(const BoxWeights& w, int i, const NodeLine* line, grid::NodeSum* node)
{
    const GiftLines gift = detail::unfolded<Affine>(line);
    constexpr bool slopes = Affine || Give == BoxGive::all;
    Lanes z_weight[Z], y_weight[Y];
    NodeLine z_slope[Z], y_slope[Y];
    for (int k = 0; k < Z; ++k) {
        z_weight[k] = Lanes(w.weight[2][k][i]);
        if constexpr (slopes) z_slope[k] = detail::scatter_coefficient<Affine>(w, 2, k, i);
    }
    for (int j = 0; j < Y; ++j) {
        y_weight[j] = Lanes(w.weight[1][j][i]);
        if constexpr (slopes) y_slope[j] = detail::scatter_coefficient<Affine>(w, 1, j, i);
    }
    for (int a = 0; a < X; ++a) {
        const Lanes x_weight(w.weight[0][a][i]);
        NodeLine base_a, y_a, z_a;
        if constexpr (Affine)
            base_a = x_weight * gift.base + detail::scatter_coefficient<Affine>(w, 0, a, i) * gift.slope[0];
        else if constexpr (slopes)
            base_a = detail::halves(NodeLine(x_weight), detail::scatter_coefficient<Affine>(w, 0, a, i)) * gift.base;
        else
            base_a = x_weight * gift.base;
        if constexpr (slopes) {
            y_a = x_weight * gift.slope[1];
            z_a = x_weight * gift.slope[2];
        }
        for (int b = 0; b < Y; ++b) {
            NodeLine base_b = y_weight[b] * base_a, z_b;
            if constexpr (slopes) {
                base_b += y_slope[b] * y_a;
                z_b = y_weight[b] * z_a;
            }
            for (int c = 0; c < Z; ++c) {
                Real* target = &node[(a * reach_side + b) * reach_side + c].mass;
                NodeLine sum = NodeLine::load(target) + z_weight[c] * base_b;
                if constexpr (slopes) sum += z_slope[c] * z_b;
                sum.store(target);
            }
        }
    }
}

template <bool Affine, BoxGive Give>
inline constexpr std::array scatter_walks{scatter_box<Affine, Give, 2, 2, 2>, scatter_box<Affine, Give, 2, 2, 3>,
                                          scatter_box<Affine, Give, 2, 3, 2>, scatter_box<Affine, Give, 2, 3, 3>,
                                          scatter_box<Affine, Give, 3, 2, 2>, scatter_box<Affine, Give, 3, 2, 3>,
                                          scatter_box<Affine, Give, 3, 3, 2>, scatter_box<Affine, Give, 3, 3, 3>};

/// Add the part of a cut box to the sum tile of its leaf.
inline void scatter_part(const BoxPart& part, const BoxGift& gift, grid::NodeSum* tile)
{
    NodeLine base = NodeLine::load(gift.base.data());
    NodeLine slope[3];
    for (std::size_t a = 0; a < 3; ++a) slope[a] = NodeLine::load(gift.slope[a].data());
    if (part.reflected) {
        const NodeLine sign = detail::signs(part, 1);
        base *= sign;
        for (NodeLine& line : slope) line *= sign;
    }
    const NodeLine momentum = NodeLine::load(detail::momentum_lanes), force = NodeLine::load(detail::force_lanes);
    for (int corner = 0; corner < 8; ++corner) {
        const int n[3] = {corner >> 2, corner >> 1 & 1, corner & 1};
        const Real w[3] = {part.axis[0].weight[n[0]], part.axis[1].weight[n[1]], part.axis[2].weight[n[2]]};
        Real* target = &tile[part.node + grid::tile_index(n[0], n[1], n[2])].mass;
        NodeLine line = NodeLine::load(target) + Lanes(w[0] * w[1] * w[2]) * base;
        for (int a = 0; a < 3; ++a) {
            const Real across = w[(a + 1) % 3] * w[(a + 2) % 3];
            line += (Lanes(across * w[a] * part.axis[a].arm[n[a]]) * momentum +
                     Lanes(across * part.axis[a].slope[n[a]]) * force) *
                    slope[a];
        }
        line.store(target);
    }
}
} // namespace transfer
