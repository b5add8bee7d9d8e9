/// A block: cells of one leaf side by side, one per SIMD lane, and the state of their particles.
///
/// The state is stored as the kernels use it, [slot][cell], four kilobytes per block in one piece. Cells that lack
/// particles (cut by a surface) have zero volume in their slots, and so have the lanes behind a leaf's last cell. How
/// cells meet their nodes: transfer/leaf_columns.h.
#pragma once

#include "core/simd.h"
#include "grid/levels.h"
#include "particles/particles.h"
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
    unsigned starts = 0;                      // bit i: cell i does not follow cell i - 1 along z

    /// @pre count < lanes
    void add(int leaf_cell, std::uint32_t first_particle, std::uint8_t slots_with_particles)
    {
        const auto i = static_cast<std::size_t>(count++);
        cell[i] = leaf_cell;
        node[i] = grid::tile_index(leaf_cell >> 6, leaf_cell >> 3 & 7, leaf_cell & 7);
        begin[i] = first_particle;
        filled[i] = slots_with_particles;
        if (i == 0 || node[i] != node[i - 1] + 1) starts |= 1u << i;
    }
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
    /// Bits of the cells that begin a run along z.
    unsigned starts() const { return (block.starts >> first() | 1u) & ((1u << count()) - 1u); }
    /// A run along z fills every lane.
    bool one_run() const { return count() == part_lanes<T> && starts() == 1; }
    int cell(int i) const { return block.cell[lane(i)]; }
    int node(int i) const { return block.node[lane(i)]; }
    bool has(int i, int slot) const { return block.has(first() + i, slot); }
    bool full(int i) const { return block.filled[lane(i)] == 0xff; }
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
} // namespace transfer
