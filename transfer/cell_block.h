/// A block: cells of one leaf side by side, one per SIMD lane, the state of their particles, and how node lines become
/// lanes.
///
/// The state is stored as the kernels use it, [slot][cell], four kilobytes per block in one piece. Cells that lack
/// particles (cut by a surface) have zero volume in their slots, and so have the lanes behind a leaf's last cell. A
/// node is one line of eight reals; eight lines are transposed in registers.
#pragma once

#include "core/simd.h"
#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/slot_slopes.h"

#include <array>
#include <bit>
#include <cstdint>

namespace transfer
{
/// Cells per block: as many numbers as fit the widest vectors, for every instruction set.
template <class T>
inline constexpr int block_lanes = 64 / static_cast<int>(sizeof(T));

template <class T>
using BlockLanes = core::Pack<T, block_lanes<T>>;

template <class T>
struct CellBlock
{
    static constexpr int lanes = block_lanes<T>;
    int count = 0;                            // cells; the lanes behind them are empty
    std::array<std::int32_t, lanes> cell{};   // in the leaf
    std::array<std::int32_t, lanes> node{};   // tile index of the lower corner
    std::array<std::uint32_t, lanes> begin{}; // first particle
    std::array<std::uint8_t, lanes> filled{}; // bit s: slot s has a particle

    /// Particle in an occupied slot.
    std::size_t particle(int lane, int slot) const
    {
        const auto i = static_cast<std::size_t>(lane);
        const unsigned below = filled[i] & ((1u << slot) - 1u);
        return begin[i] + static_cast<std::size_t>(std::popcount(below));
    }
    bool has(int lane, int slot) const { return (filled[static_cast<std::size_t>(lane)] >> slot & 1) != 0; }
};

/// What the particles of a block remember; slot s of lane i stands at [s][i].
template <class T>
struct alignas(64) BlockState
{
    using Slots = std::array<std::array<T, block_lanes<T>>, slots>;
    Slots rest_volume;           // mm^3
    Slots eq_plastic_strain;     // 1
    std::array<Slots, 6> stress; // MPa, Cauchy: xx yy zz xy yz zx
};

template <class T>
[[gnu::always_inline]] inline BlockLanes<T> load_slot(const typename BlockState<T>::Slots& from, int slot)
{
    return BlockLanes<T>::load(from[static_cast<std::size_t>(slot)].data());
}
template <class T>
[[gnu::always_inline]] inline void store_slot(const BlockLanes<T>& lanes, int slot, typename BlockState<T>::Slots& to)
{
    lanes.store(to[static_cast<std::size_t>(slot)].data());
}

namespace detail
{
using Row = core::Pack<Real, 8>;

/// Two rows of eight as one vector of sixteen.
[[gnu::always_inline]] inline core::Pack<float, 16> joined(const Row& lower, const Row& upper)
{
    const auto a = core::convert<float>(lower), b = core::convert<float>(upper);
    return {__builtin_shufflevector(a.v, b.v, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)};
}
[[gnu::always_inline]] inline Row lower_row(const core::Pack<float, 16>& both)
{
    return core::convert<Real>(core::Pack<float, 8>{__builtin_shufflevector(both.v, both.v, 0, 1, 2, 3, 4, 5, 6, 7)});
}
[[gnu::always_inline]] inline Row upper_row(const core::Pack<float, 16>& both)
{
    return core::convert<Real>(
        core::Pack<float, 8>{__builtin_shufflevector(both.v, both.v, 8, 9, 10, 11, 12, 13, 14, 15)});
}

/// Make `lanes` rows of eight, `row(lane)`, into eight vectors of lanes.
template <class T, class RowOf>
[[gnu::always_inline]] inline void rows_to_lanes(const RowOf& row, BlockLanes<T> (&out)[8])
{
    for (int i = 0; i < 8; ++i) {
        if constexpr (block_lanes<T> == 8)
            out[i] = row(i);
        else
            out[i] = joined(row(i), row(i + 8));
    }
    core::transpose(out);
}

/// The way back: `take(lane, row)` for every lane.
template <class T, class Take>
[[gnu::always_inline]] inline void lanes_to_rows(BlockLanes<T> (&in)[8], const Take& take)
{
    core::transpose(in);
    for (int i = 0; i < 8; ++i) {
        if constexpr (block_lanes<T> == 8) {
            take(i, in[i]);
        } else {
            take(i, lower_row(in[i]));
            take(i + 8, upper_row(in[i]));
        }
    }
}
} // namespace detail

/// Both vectors of the motion tile at the corners of every cell: [component][corner].
///
/// Values are relative to the block's first node, so that single precision sees differences and not the distance the
/// body has travelled; slopes do not change by that.
template <class T>
[[gnu::always_inline]] inline void gather_corners(const grid::NodeMotion* tile, const CellBlock<T>& block,
                                                  BlockLanes<T> (&velocity)[3][8], BlockLanes<T> (&displacement)[3][8])
{
    const detail::Row first = detail::Row::load(tile[block.node[0]].velocity.data());
    for (int c = 0; c < 8; ++c) {
        const int corner = grid::tile_index(c >> 2, c >> 1 & 1, c & 1);
        BlockLanes<T> line[8];
        detail::rows_to_lanes<T>(
            [&](int i) {
                return detail::Row::load(tile[block.node[static_cast<std::size_t>(i)] + corner].velocity.data()) -
                       first;
            },
            line);
        for (int a = 0; a < 3; ++a) {
            velocity[a][c] = line[a];
            displacement[a][c] = line[4 + a];
        }
    }
}

/// Add forces at the corners of every cell, [component][corner], to the nodes of a force tile, lane after lane.
template <class T>
[[gnu::always_inline]] inline void scatter_corners(const BlockLanes<T> (&force)[3][8], const CellBlock<T>& block,
                                                   grid::NodeForce* tile)
{
    using Half = core::Pack<Real, 4>;
    for (int pair = 0; pair < 4; ++pair) { // corners k = 0 and 1 are neighbours in the tile
        const int corner = grid::tile_index(pair >> 1, pair & 1, 0);
        BlockLanes<T> line[8];
        for (int a = 0; a < 3; ++a) {
            line[a] = force[a][2 * pair];
            line[4 + a] = force[a][2 * pair + 1];
        }
        line[3] = line[7] = BlockLanes<T>(T(0));
        detail::lanes_to_rows<T>(line, [&](int i, const detail::Row& row) {
            if (i >= block.count) return;
            grid::NodeForce* node = tile + block.node[static_cast<std::size_t>(i)] + corner;
            const Half lower{__builtin_shufflevector(row.v, row.v, 0, 1, 2, 3)};
            const Half upper{__builtin_shufflevector(row.v, row.v, 4, 5, 6, 7)};
            (Half::load(node[0].force.data()) + lower).store(node[0].force.data());
            (Half::load(node[1].force.data()) + upper).store(node[1].force.data());
        });
    }
}
} // namespace transfer
