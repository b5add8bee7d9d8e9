/// Scatter of the particles of one cell to its eight nodes: lanes are nodes, particle quantities are broadcast.
///
/// Thirteen accumulators stay in registers for all particles of a cell (hence the forced inlining): mass, momentum (3),
/// and the nine products stress x weight slope. The sign of each node's slope and 1 / spacing are applied once per
/// cell, a transpose turns quantities of all nodes into lines of single nodes, and these are added to the tile. No
/// horizontal sums. Where a vector holds less than eight numbers, the nodes are served in parts, one after the other:
/// twice thirteen accumulators would leave the registers.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "grid/levels.h"

#include <algorithm>

namespace transfer
{
/// Nodes of a cell that are served at once; lane n of part `first` is node first + n, and node 4i + 2j + k is corner
/// (i, j, k).
inline constexpr int node_lanes = core::native_lanes<Real> < 8 ? core::native_lanes<Real> : 8;
using NodeLanes = core::Pack<Real, node_lanes>;

namespace detail
{
alignas(64) inline constexpr Real corner_x[8] = {0, 0, 0, 0, 1, 1, 1, 1};
alignas(64) inline constexpr Real corner_y[8] = {0, 0, 1, 1, 0, 0, 1, 1};
alignas(64) inline constexpr Real corner_z[8] = {0, 1, 0, 1, 0, 1, 0, 1};
} // namespace detail

template <int N>
struct CellSum
{
    core::Pack<Real, N> mass;
    core::Pack<Real, N> momentum[3];
    core::Pack<Real, N> force[3][3]; // [component][direction of the slope]
};

/// All zero; written out because a loop over the struct becomes a slow string instruction.
template <int N>
[[gnu::always_inline]] inline void clear(CellSum<N>& sum)
{
    const core::Pack<Real, N> zero(Real(0));
    sum.mass = zero;
    sum.momentum[0] = sum.momentum[1] = sum.momentum[2] = zero;
    sum.force[0][0] = sum.force[0][1] = sum.force[0][2] = zero;
    sum.force[1][0] = sum.force[1][1] = sum.force[1][2] = zero;
    sum.force[2][0] = sum.force[2][1] = sum.force[2][2] = zero;
}

/// N nodes of a cell from `first` on: which side of the cell they are on, 0 or 1.
template <int N>
struct Corners
{
    core::Pack<Real, N> x, y, z;
};

template <int N>
[[gnu::always_inline]] inline Corners<N> corners_from(int first)
{
    const auto from = [&](const Real* side) { return core::Pack<Real, N>::load(side + first); };
    return {from(detail::corner_x), from(detail::corner_y), from(detail::corner_z)};
}

/// Weights of one particle on N nodes.
template <int N>
struct CornerWeights
{
    core::Pack<Real, N> w, slope_x, slope_y, slope_z; // slopes without sign and without 1 / spacing
};

template <int N>
[[gnu::always_inline]] inline CornerWeights<N> corner_weights(const Corners<N>& corners, Real xi, Real eta, Real zeta)
{
    using V = core::Pack<Real, N>;
    // One-dimensional weights: 1 - t on the lower, t on the upper side.
    const auto weight = [](const V& upper, Real t) __attribute__((always_inline))
    {
        return (V(Real(1)) - upper) + (V(Real(2)) * upper - V(Real(1))) * V(t);
    };
    const V wx = weight(corners.x, xi), wy = weight(corners.y, eta), wz = weight(corners.z, zeta);
    const V yz = wy * wz;
    return {wx * yz, yz, wx * wz, wx * wy};
}

/// `stress_volume(a, b)` is V sigma (a: component, b: direction of the gradient), or V0 P in the total formulation.
template <int N, class StressVolume>
[[gnu::always_inline]] inline void add_force(const CornerWeights<N>& weights, const StressVolume& stress_volume,
                                             CellSum<N>& sum)
{
    using V = core::Pack<Real, N>;
    for (int a = 0; a < 3; ++a) {
        sum.force[a][0] += V(stress_volume(a, 0)) * weights.slope_x;
        sum.force[a][1] += V(stress_volume(a, 1)) * weights.slope_y;
        sum.force[a][2] += V(stress_volume(a, 2)) * weights.slope_z;
    }
}

template <int N>
[[gnu::always_inline]] inline void add_momentum(const CornerWeights<N>& weights, Real px, Real py, Real pz,
                                                CellSum<N>& sum)
{
    using V = core::Pack<Real, N>;
    sum.momentum[0] += V(px) * weights.w;
    sum.momentum[1] += V(py) * weights.w;
    sum.momentum[2] += V(pz) * weights.w;
}

/// Affine part m C (x_i - x_p) of APIC; `rate(a, b)` is m C spacing.
template <int N, class Rate>
[[gnu::always_inline]] inline void add_affine(const Corners<N>& corners, const CornerWeights<N>& weights, Real xi,
                                              Real eta, Real zeta, const Rate& rate, CellSum<N>& sum)
{
    using V = core::Pack<Real, N>;
    const V dx = weights.w * (corners.x - V(xi));
    const V dy = weights.w * (corners.y - V(eta));
    const V dz = weights.w * (corners.z - V(zeta));
    for (int a = 0; a < 3; ++a) sum.momentum[a] += V(rate(a, 0)) * dx + V(rate(a, 1)) * dy + V(rate(a, 2)) * dz;
}

/// Add the sums of N nodes from `first` on.
/// @tparam Momentum    no force: with short vectors only the first half of each node's line is touched
/// @param per_spacing  1 / spacing
/// @param node         the cell's lower-corner node in a sum tile
template <bool Momentum = false, int N>
[[gnu::always_inline]] inline void write_sums(const CellSum<N>& sum, int first, Real per_spacing, grid::NodeSum* node)
{
    using V = core::Pack<Real, N>;
    // f = - V sigma grad w; the slope's sign is -1 on the lower and +1 on the upper corners.
    const Corners<N> corners = corners_from<N>(first);
    const auto sign = [&](const V& upper) { return (V(Real(1)) - V(Real(2)) * upper) * V(per_spacing); };
    const V sign_x = sign(corners.x), sign_y = sign(corners.y), sign_z = sign(corners.z);
    V line[8];
    line[0] = sum.mass;
    for (int a = 0; a < 3; ++a) line[1 + a] = sum.momentum[a];
    for (int a = 0; a < 4; ++a) line[4 + a] = V(Real(0));
    if constexpr (!Momentum)
        for (int a = 0; a < 3; ++a)
            line[4 + a] = sum.force[a][0] * sign_x + sum.force[a][1] * sign_y + sum.force[a][2] * sign_z;
    constexpr int end = Momentum ? std::max(N, 4) : 8;
    for (int place = 0; place < end; place += N) {
        V square[N];
        for (int n = 0; n < N; ++n) square[n] = line[place + n];
        core::transpose(square);
        for (int n = 0; n < N; ++n) {
            const int corner = first + n;
            Real* target = &node[grid::tile_index(corner >> 2, corner >> 1 & 1, corner & 1)].mass + place;
            (V::load(target) + square[n]).store(target);
        }
    }
}
} // namespace transfer
