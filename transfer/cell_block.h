/// A block: cells of one leaf side by side, one per SIMD lane, the state of their particles, and how they meet the
/// nodes.
///
/// The state is stored as the kernels use it, [slot][cell], four kilobytes per block in one piece. Cells that lack
/// particles (cut by a surface) have zero volume in their slots, and so have the lanes behind a leaf's last cell. A
/// node is one line of eight reals; eight lines are transposed in registers.
#pragma once

#include "core/simd.h"
#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/line_lanes.h"
#include "transfer/slot_slopes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace transfer
{
/// Cells per block: as many numbers as fit the widest vectors, for every instruction set.
template <class T>
inline constexpr int block_lanes = 64 / static_cast<int>(sizeof(T));

/// Cells that a kernel works on at once: what one vector of the instruction set holds. A block is worked on in parts.
template <class T>
inline constexpr int part_lanes = core::native_lanes<T> < block_lanes<T> ? core::native_lanes<T> : block_lanes<T>;

template <class T>
using PartLanes = core::Pack<T, part_lanes<T>>;

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

/// Some neighbouring lanes of a block, as many as a vector holds; lanes are counted from the part's first.
template <class T>
struct BlockPart
{
    const CellBlock<T>& block;
    int begin; // lane of the block

    int first() const { return part_lanes<T> == block_lanes<T> ? 0 : begin; }
    int count() const { return std::min(block.count - first(), part_lanes<T>); } // cells
    std::size_t lane(int i) const { return static_cast<std::size_t>(first() + i); }
    int cell(int i) const { return block.cell[lane(i)]; }
    int node(int i) const { return block.node[lane(i)]; }
    bool has(int i, int slot) const { return block.has(first() + i, slot); }
    std::size_t particle(int i, int slot) const { return block.particle(first() + i, slot); }

    [[gnu::always_inline]] PartLanes<T> load(const typename BlockState<T>::Slots& from, int slot) const
    {
        return PartLanes<T>::load(from[static_cast<std::size_t>(slot)].data() + first());
    }
    [[gnu::always_inline]] void store(const PartLanes<T>& lanes, int slot, typename BlockState<T>::Slots& to) const
    {
        lanes.store(to[static_cast<std::size_t>(slot)].data() + first());
    }
};

/// Both vectors of the motion tile at the corners of every cell: [component][corner].
///
/// Values are relative to the part's first node, so that single precision sees differences and not the distance the
/// body has travelled; slopes do not change by that.
template <class T>
[[gnu::always_inline]] inline void gather_corners(const grid::NodeMotion* tile, const BlockPart<T>& part,
                                                  PartLanes<T> (&velocity)[3][8], PartLanes<T> (&displacement)[3][8])
{
    constexpr int size = line_piece<part_lanes<T>>;
    using Piece = core::Pack<Real, size>;
    Piece first[8 / size];
    for (int n = 0; n < 8 / size; ++n) first[n] = Piece::load(tile[part.node(0)].velocity.data() + n * size);
    for (int c = 0; c < 8; ++c) {
        const int corner = grid::tile_index(c >> 2, c >> 1 & 1, c & 1);
        PartLanes<T> line[8];
        lines_to_lanes(
            [&](int i, int place) __attribute__((always_inline)) {
                return Piece::load(tile[part.node(i) + corner].velocity.data() + place) - first[place / size];
            },
            line);
        for (int a = 0; a < 3; ++a) {
            velocity[a][c] = line[a];
            displacement[a][c] = line[4 + a];
        }
    }
}

namespace detail
{
/// Add numbers of the two neighbouring nodes n and n + 1, from `place` on.
template <int N>
[[gnu::always_inline]] inline void add_to_nodes(const core::Pack<Real, N>& piece, int place, grid::NodeForce* n)
{
    Real* target = n[place / 4].force.data() + place % 4;
    (core::Pack<Real, N>::load(target) + piece).store(target);
}
[[gnu::always_inline]] inline void add_to_nodes(const core::Pack<Real, 8>& both, int, grid::NodeForce* n)
{
    add_to_nodes(core::Pack<Real, 4>{__builtin_shufflevector(both.v, both.v, 0, 1, 2, 3)}, 0, n);
    add_to_nodes(core::Pack<Real, 4>{__builtin_shufflevector(both.v, both.v, 4, 5, 6, 7)}, 4, n);
}
} // namespace detail

/// Add forces at the corners of every cell, [component][corner], to the nodes of a force tile, lane after lane.
template <class T>
[[gnu::always_inline]] inline void scatter_corners(const PartLanes<T> (&force)[3][8], const BlockPart<T>& part,
                                                   grid::NodeForce* tile)
{
    const int count = part.count();
    for (int pair = 0; pair < 4; ++pair) { // corners k = 0 and 1 are neighbours in the tile
        const int corner = grid::tile_index(pair >> 1, pair & 1, 0);
        PartLanes<T> line[8];
        for (int a = 0; a < 3; ++a) {
            line[a] = force[a][2 * pair];
            line[4 + a] = force[a][2 * pair + 1];
        }
        line[3] = line[7] = PartLanes<T>(T(0));
        lanes_to_lines(
            line, [&](int i, int place, const core::Pack<Real, line_piece<part_lanes<T>>>& piece)
                      __attribute__((always_inline)) {
                          if (i < count) detail::add_to_nodes(piece, place, tile + part.node(i) + corner);
                      });
    }
}
} // namespace transfer
