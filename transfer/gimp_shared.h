/// Boxes of a chunk that lie in the same 2 x 2 x 2 cells: all of them read the same nodes, so lanes = particles.
///
/// Particles of a cell mostly move together, so along each axis all their boxes reach over its lower face, or all over
/// its upper one, or none over any. With m the lowest cell of the chunk, N0, N1, N2 the values of the nodes m, m + 1,
/// m + 2 and w, s weight and slope of a box there, along an axis
///
///     sum w N = N1 + w0 (N0 - N1) + w2 (N2 - N1),      sum s N = s0 (N0 - N1) + s2 (N2 - N1)
///
/// as weights add up to 1 and slopes to 0. First moments w d, with d = x_i - x_p, add up to 0 as well (hat functions
/// are linearly complete), and are summed like slopes. The differences of all three axes are the same for the chunk and
/// are taken once, on lines of a node's eight quantities; then every quantity is a sum over 8 to 27 numbers that every
/// lane shares. This takes 264 multiply-adds a chunk where walks (gimp_lines.h) take 408 (FLIP, 8 lanes), and nothing
/// has to be transposed. Node values that are equal give slopes of exactly zero.
#pragma once

#include "transfer/gimp_weights.h"
#include "transfer/node_line.h"

namespace transfer
{
/// What is read off the grid besides the lanes of grid::NodeMotion.
enum class BoxRead
{
    values,          // nothing
    velocity_slopes, // slopes of the velocity
    change_slopes,   // slopes of its change
    affine,          // slopes and moments of the velocity, instead of its change
};

/// What a chunk of boxes has read, one array entry per particle.
struct BoxChunk
{
    static constexpr int lanes = BoxWeights::lanes;
    alignas(64) Real value[8][lanes];    // quantities of grid::NodeMotion; affine: the velocity in the first three
    alignas(64) Real gradient[9][lanes]; // 1/ms, of the velocity or its change, row by row
    alignas(64) Real affine[9][lanes];   // 1/ms, C of APIC
};

/// What boxes have for the nodes m and m + 2 of an axis.
struct SharedAxis
{
    Lanes weight0, weight2;
    Lanes slope0, slope2;   // 1/mm
    Lanes moment0, moment2; // mm; APIC
    Lanes inertia;          // mm^2, sum w d^2; APIC
};

struct SharedBoxes
{
    int node; // reach_index of the lowest one
    int code; // axes with three nodes: 4 x + 2 y + z
    SharedAxis axis[3];
};

namespace detail
{
/// Of a mirror image not every box that fits into served cells is served: it must not lie among the images as a whole.
[[gnu::always_inline]] inline bool each_served(const ReachMap& map, const BoxFrame& frame, const BoxAxes& axes,
                                               int count)
{
    std::int32_t place[Lanes::lanes];
    store_places(frame, axes, place);
    bool all = true;
    for (int i = 0; i < count; ++i) all = all && served(map, place[i]);
    return all;
}

/// The weights of one axis for the nodes from cell `m` on; in the lanes of `next` a box lies in the cell m + 1.
template <bool Arms>
[[gnu::always_inline]] inline SharedAxis shared_axis(const AxisLanes& box, Lanes m, LaneMask next, Lanes spacing)
{
    const Lanes one(Real(1)), zero(Real(0));
    SharedAxis axis;
    axis.weight0 = core::select(next, zero, box.weight0);
    axis.weight2 = core::select(next, one - box.weight0, box.weight2);
    axis.slope0 = core::select(next, zero, box.slope0);
    axis.slope2 = core::select(next, -box.slope0, box.slope2);
    if constexpr (Arms) {
        const Lanes arm0 = (m - box.centre) * spacing, arm1 = arm0 + spacing, arm2 = arm1 + spacing;
        axis.moment0 = axis.weight0 * arm0;
        axis.moment2 = axis.weight2 * arm2;
        axis.inertia = axis.moment0 * arm0 + (one - axis.weight0 - axis.weight2) * arm1 * arm1 + axis.moment2 * arm2;
    }
    return axis;
}
} // namespace detail

/// Do the first `count` boxes lie in the same 2 x 2 x 2 cells, all of them served? Then `shared` is set.
/// @tparam Arms  also moments (APIC)
template <bool Arms>
[[gnu::always_inline]] inline bool share_cells(const ReachMap& map, const BoxFrame& frame, const BoxAxes& axes,
                                               int count, SharedBoxes& shared)
{
    const Lanes one(Real(1)), zero(Real(0));
    const LaneMask here = core::first_lanes<Real, Lanes::lanes>(count);
    LaneMask fits = here;
    shared.node = 0;
    shared.code = 0;
    bool near = true;
    for (std::size_t a = 0; a < 3; ++a) {
        const AxisLanes& box = axes[a];
        Real lowest = box.cell[0];
        if (core::any(here & (box.cell < Lanes(lowest)))) lowest -= 1;
        const Lanes m(lowest);
        const LaneMask reaches = box.beyond > zero, next = box.cell > m;
        fits = fits & (box.cell >= m) & (box.beyond <= one) & (box.cell + core::select(reaches, one, zero) <= m + one);
        shared.axis[a] = detail::shared_axis<Arms>(box, m, next, Lanes(frame.spacing));
        const Real local = lowest - frame.lower[a];
        near = near && local >= -1 && local <= grid::leaf_side;
        shared.node = shared.node * reach_side + (near ? static_cast<int>(local) + 1 : 0);
        shared.code = 2 * shared.code + (core::any(here & (reaches | next)) ? 1 : 0);
    }
    if (!near || core::any(here & !fits) || !served(map, 8 * shared.node + shared.code)) return false;
    return map.mirrors == 0 || detail::each_served(map, frame, axes, count);
}

namespace detail
{
/// Values at the nodes of an axis become (N0 - N1, N1, N2 - N1).
template <int N>
[[gnu::always_inline]] inline void take_differences(NodeLine& n0, NodeLine& n1, NodeLine* n2)
{
    n0 -= n1;
    if constexpr (N == 3) *n2 -= n1;
}

/// a c[0] + b c[2]; of two nodes the first term.
template <int N>
[[gnu::always_inline]] inline Lanes sum_of(Lanes a, Lanes b, const Lanes* c)
{
    const Lanes sum = a * c[0];
    if constexpr (N == 3) return sum + b * c[2];
    return sum;
}
template <int N>
[[gnu::always_inline]] inline Lanes value_of(const SharedAxis& axis, const Lanes* c)
{
    const Lanes sum = c[1] + axis.weight0 * c[0];
    if constexpr (N == 3) return sum + axis.weight2 * c[2];
    return sum;
}
template <int N>
[[gnu::always_inline]] inline Lanes slope_of(const SharedAxis& axis, const Lanes* c)
{
    return sum_of<N>(axis.slope0, axis.slope2, c);
}
template <int N>
[[gnu::always_inline]] inline Lanes moment_of(const SharedAxis& axis, const Lanes* c)
{
    return sum_of<N>(axis.moment0, axis.moment2, c);
}

/// What boxes read of one quantity of the nodes.
struct QuantityLanes
{
    Lanes value;
    Lanes slope[3];
    Lanes moment[3];
};

/// Differences of all quantities, [x][y][z][quantity].
template <int X, int Y, int Z>
using SharedField = Real[X][Y][Z][8];

template <int X, int Y, int Z>
[[gnu::always_inline]] inline void read_field(const grid::NodeMotion* node, SharedField<X, Y, Z>& field)
{
    NodeLine line[X][Y][Z];
    for (int a = 0; a < X; ++a)
        for (int b = 0; b < Y; ++b) {
            for (int c = 0; c < Z; ++c)
                line[a][b][c] = NodeLine::load(node[(a * reach_side + b) * reach_side + c].velocity.data());
            take_differences<Z>(line[a][b][0], line[a][b][1], line[a][b] + Z - 1);
        }
    for (int a = 0; a < X; ++a)
        for (int c = 0; c < Z; ++c) take_differences<Y>(line[a][0][c], line[a][1][c], &line[a][Y - 1][c]);
    for (int b = 0; b < Y; ++b)
        for (int c = 0; c < Z; ++c) {
            take_differences<X>(line[0][b][c], line[1][b][c], &line[X - 1][b][c]);
            for (int a = 0; a < X; ++a) line[a][b][c].store(field[a][b][c]);
        }
}

template <bool Slopes, bool Moments, int X, int Y, int Z>
[[gnu::always_inline]] inline QuantityLanes read_quantity(const SharedBoxes& boxes, const SharedField<X, Y, Z>& field,
                                                          int quantity)
{
    const SharedAxis &x = boxes.axis[0], &y = boxes.axis[1], &z = boxes.axis[2];
    Lanes value[X], along_y[X], along_z[X], moment_y[X], moment_z[X];
    for (int a = 0; a < X; ++a) {
        Lanes row[Y], slope[Y], moment[Y];
        for (int b = 0; b < Y; ++b) {
            Lanes node[Z];
            for (int c = 0; c < Z; ++c) node[c] = Lanes(field[a][b][c][quantity]);
            row[b] = value_of<Z>(z, node);
            if constexpr (Slopes) slope[b] = slope_of<Z>(z, node);
            if constexpr (Moments) moment[b] = moment_of<Z>(z, node);
        }
        value[a] = value_of<Y>(y, row);
        if constexpr (Slopes) {
            along_y[a] = slope_of<Y>(y, row);
            along_z[a] = value_of<Y>(y, slope);
        }
        if constexpr (Moments) {
            moment_y[a] = moment_of<Y>(y, row);
            moment_z[a] = value_of<Y>(y, moment);
        }
    }
    QuantityLanes read;
    read.value = value_of<X>(x, value);
    if constexpr (Slopes) {
        read.slope[0] = slope_of<X>(x, value);
        read.slope[1] = value_of<X>(x, along_y);
        read.slope[2] = value_of<X>(x, along_z);
    }
    if constexpr (Moments) {
        read.moment[0] = moment_of<X>(x, value);
        read.moment[1] = value_of<X>(x, moment_y);
        read.moment[2] = value_of<X>(x, moment_z);
    }
    return read;
}
} // namespace detail

/// Read all boxes; `node` is the lowest one in the reach tile.
template <BoxRead Read, int X, int Y, int Z>
[[gnu::noinline]] void gather_shared(const SharedBoxes& boxes, const grid::NodeMotion* node, BoxChunk& chunk)
{
    alignas(64) detail::SharedField<X, Y, Z> field;
    detail::read_field<X, Y, Z>(node, field);
    constexpr bool affine = Read == BoxRead::affine;
    constexpr bool of_velocity = affine || Read == BoxRead::velocity_slopes, of_change = Read == BoxRead::change_slopes;
    const auto keep = [&](const detail::QuantityLanes& read, int component) {
        for (int a = 0; a < 3; ++a) read.slope[a].store(chunk.gradient[3 * component + a]);
    };
    for (int q = 0; q < 3; ++q) {
        const auto velocity = detail::read_quantity<of_velocity, affine, X, Y, Z>(boxes, field, velocity_column + q);
        velocity.value.store(chunk.value[velocity_column + q]);
        if constexpr (of_velocity) keep(velocity, q);
        if constexpr (affine)
            for (int a = 0; a < 3; ++a) (velocity.moment[a] / boxes.axis[a].inertia).store(chunk.affine[3 * q + a]);
        if constexpr (!affine) {
            const auto change = detail::read_quantity<of_change, false, X, Y, Z>(boxes, field, change_column + q);
            change.value.store(chunk.value[change_column + q]);
            if constexpr (of_change) keep(change, q);
        }
    }
}

/// The same by SharedBoxes::code.
template <BoxRead Read>
inline constexpr std::array shared_gathers{gather_shared<Read, 2, 2, 2>, gather_shared<Read, 2, 2, 3>,
                                           gather_shared<Read, 2, 3, 2>, gather_shared<Read, 2, 3, 3>,
                                           gather_shared<Read, 3, 2, 2>, gather_shared<Read, 3, 2, 3>,
                                           gather_shared<Read, 3, 3, 2>, gather_shared<Read, 3, 3, 3>};
} // namespace transfer
