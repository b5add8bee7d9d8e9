/// Scatter of the particles of one cell to its eight nodes: lanes are nodes, particle quantities are broadcast.
///
/// Thirteen accumulators stay in registers for all particles of a cell (hence the forced inlining): mass, momentum (3),
/// and the nine products stress x weight slope. The sign of each node's slope and 1 / spacing are applied once per
/// cell, one 8x8 transpose turns quantities of all nodes into cache lines of single nodes, and eight lines are added to
/// the tile. No horizontal sums.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "grid/levels.h"

namespace transfer
{
/// One lane per node of the cell: lane 4i + 2j + k is corner (i, j, k).
using NodeLanes = core::Pack<Real, 8>;

namespace detail
{
inline constexpr NodeLanes::Lanes corner_x = {0, 0, 0, 0, 1, 1, 1, 1};
inline constexpr NodeLanes::Lanes corner_y = {0, 0, 1, 1, 0, 0, 1, 1};
inline constexpr NodeLanes::Lanes corner_z = {0, 1, 0, 1, 0, 1, 0, 1};
} // namespace detail

/// One-dimensional weights of the eight corners for a coordinate t: 1 - t on the lower, t on the upper side.
[[gnu::always_inline]] inline NodeLanes corner_weight(NodeLanes::Lanes upper, Real t)
{
    return NodeLanes(NodeLanes::Lanes(Real(1) - upper)) +
           NodeLanes(NodeLanes::Lanes(2 * upper - Real(1))) * NodeLanes(t);
}

struct CellSum
{
    NodeLanes mass;
    NodeLanes momentum[3];
    NodeLanes force[3][3]; // [component][direction of the slope]
};

/// All zero; written out because a loop over the struct becomes a slow string instruction.
[[gnu::always_inline]] inline void clear(CellSum& sum)
{
    const NodeLanes zero(Real(0));
    sum.mass = zero;
    sum.momentum[0] = sum.momentum[1] = sum.momentum[2] = zero;
    sum.force[0][0] = sum.force[0][1] = sum.force[0][2] = zero;
    sum.force[1][0] = sum.force[1][1] = sum.force[1][2] = zero;
    sum.force[2][0] = sum.force[2][1] = sum.force[2][2] = zero;
}

/// Weights of one particle on the eight corners.
struct CornerWeights
{
    NodeLanes w, slope_x, slope_y, slope_z; // slopes without sign and without 1 / spacing
};

[[gnu::always_inline]] inline CornerWeights corner_weights(Real xi, Real eta, Real zeta)
{
    const NodeLanes wx = corner_weight(detail::corner_x, xi);
    const NodeLanes wy = corner_weight(detail::corner_y, eta);
    const NodeLanes wz = corner_weight(detail::corner_z, zeta);
    const NodeLanes yz = wy * wz;
    return {wx * yz, yz, wx * wz, wx * wy};
}

/// `stress_volume(a, b)` is V sigma (a: component, b: direction of the gradient), or V0 P in the total formulation.
template <class StressVolume>
[[gnu::always_inline]] inline void add_force(const CornerWeights& weights, const StressVolume& stress_volume,
                                             CellSum& sum)
{
    for (int a = 0; a < 3; ++a) {
        sum.force[a][0] += NodeLanes(stress_volume(a, 0)) * weights.slope_x;
        sum.force[a][1] += NodeLanes(stress_volume(a, 1)) * weights.slope_y;
        sum.force[a][2] += NodeLanes(stress_volume(a, 2)) * weights.slope_z;
    }
}

[[gnu::always_inline]] inline void add_momentum(const CornerWeights& weights, Real px, Real py, Real pz, CellSum& sum)
{
    sum.momentum[0] += NodeLanes(px) * weights.w;
    sum.momentum[1] += NodeLanes(py) * weights.w;
    sum.momentum[2] += NodeLanes(pz) * weights.w;
}

/// Affine part m C (x_i - x_p) of APIC; `rate(a, b)` is m C spacing.
template <class Rate>
[[gnu::always_inline]] inline void add_affine(const CornerWeights& weights, Real xi, Real eta, Real zeta,
                                              const Rate& rate, CellSum& sum)
{
    const NodeLanes dx = weights.w * (NodeLanes(detail::corner_x) - NodeLanes(xi));
    const NodeLanes dy = weights.w * (NodeLanes(detail::corner_y) - NodeLanes(eta));
    const NodeLanes dz = weights.w * (NodeLanes(detail::corner_z) - NodeLanes(zeta));
    for (int a = 0; a < 3; ++a)
        sum.momentum[a] += NodeLanes(rate(a, 0)) * dx + NodeLanes(rate(a, 1)) * dy + NodeLanes(rate(a, 2)) * dz;
}

/// Add the cell's sums to its nodes.
/// @param per_spacing  1 / spacing
/// @param node         the cell's lower-corner node in a sum tile
[[gnu::always_inline]] inline void write_cell(const CellSum& sum, Real per_spacing, grid::NodeSum* node)
{
    // f = - V sigma grad w; the slope's sign is -1 on the lower and +1 on the upper corners.
    const NodeLanes sign_x(NodeLanes::Lanes((Real(1) - 2 * detail::corner_x) * per_spacing));
    const NodeLanes sign_y(NodeLanes::Lanes((Real(1) - 2 * detail::corner_y) * per_spacing));
    const NodeLanes sign_z(NodeLanes::Lanes((Real(1) - 2 * detail::corner_z) * per_spacing));
    NodeLanes line[8];
    line[0] = sum.mass;
    for (int a = 0; a < 3; ++a) line[1 + a] = sum.momentum[a];
    for (int a = 0; a < 3; ++a)
        line[4 + a] = sum.force[a][0] * sign_x + sum.force[a][1] * sign_y + sum.force[a][2] * sign_z;
    line[7] = NodeLanes(Real(0));
    core::transpose(line);
    for (int n = 0; n < 8; ++n) {
        Real* target = &node[grid::tile_index(n >> 2, n >> 1 & 1, n & 1)].mass;
        (NodeLanes::load(target) + line[n]).store(target);
    }
}
} // namespace transfer
