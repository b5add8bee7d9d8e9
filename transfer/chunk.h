/// A chunk: up to `Lanes::lanes` particles of one cell, one per SIMD lane, and how its columns become lanes.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/cell_field.h"
#include "transfer/law_table.h"
#include "transfer/scheme.h"
#include "transfer/solid_share.h"

#include <cstring>

namespace transfer
{
using Lanes = core::Pack<Real, core::native_lanes<Real>>;
using LaneMask = core::Mask<Real, Lanes::lanes>;

/// Where a cell sits: what turns a position into local coordinates.
struct CellFrame
{
    std::array<Real, 3> lower{}; // 1, index of the lower corner on its level
    Vec3 origin = Vec3::Zero();  // mm, of the lattice
    Real per_spacing = 1;        // 1/mm
    int node = 0;                // tile index of the lower corner
};

/// What the cells of one leaf share; made once per leaf, because its divisions would start every cell's chain.
struct LeafFrame
{
    Index3 lower = Index3::Zero(); // 1, index of the leaf's lower corner
    Vec3 origin = Vec3::Zero();    // mm, of the lattice
    Real per_spacing = 1;          // 1/mm
};

inline LeafFrame leaf_frame(const grid::Levels& levels, std::size_t leaf)
{
    return {levels.leaves[leaf].origin, levels.origin, Real(1) / levels.spacing(levels.leaves[leaf].level)};
}

inline CellFrame cell_frame(const LeafFrame& leaf, int cell)
{
    const int i = cell >> 6, j = cell >> 3 & 7, k = cell & 7;
    return {{Real(leaf.lower[0] + i), Real(leaf.lower[1] + j), Real(leaf.lower[2] + k)},
            leaf.origin,
            leaf.per_spacing,
            grid::tile_index(i, j, k)};
}

template <std::size_t N>
using Columns = std::array<particles::Column, N>;

[[gnu::always_inline]] inline Lanes load(const particles::Column& column, std::size_t begin, int count)
{
    return core::load_tail<Real, Lanes::lanes>(column.data() + begin, count);
}

template <class Tensor, std::size_t N>
[[gnu::always_inline]] inline Tensor load_all(const Columns<N>& columns, std::size_t begin, int count)
{
    return [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline))
    {
        return Tensor{{load(columns[I], begin, count)...}};
    }
    (std::make_index_sequence<N>{});
}

/// Write the first `count` lanes.
[[gnu::always_inline]] inline void store(Lanes lanes, particles::Column& column, std::size_t begin, int count)
{
    core::store_tail(lanes, column.data() + begin, count);
}

/// Weights are taken where the formulation says: at rest or at current positions.
template <Formulation F>
const Columns<3>& weight_position(const particles::Particles& particles)
{
    if constexpr (F == Formulation::total)
        return particles.rest_position;
    else
        return particles.position;
}

template <class V>
LocalPosition<V> local_position(const CellFrame& frame, const core::Vec<V>& x)
{
    const auto local = [&](int a) {
        return (x[a] - V(frame.origin[a])) * V(frame.per_spacing) - V(frame.lower[static_cast<unsigned>(a)]);
    };
    return {local(0), local(1), local(2)};
}

/// Lanes whose position lies in the cell: the test of grid::Refinement::locate.
inline LaneMask inside(const CellFrame& frame, const core::Vec<Lanes>& x)
{
    const auto between = [&](int a) {
        const Lanes scaled = (x[a] - Lanes(frame.origin[a])) * Lanes(frame.per_spacing);
        const Real lower = frame.lower[static_cast<unsigned>(a)];
        return (scaled >= Lanes(lower)) & (scaled < Lanes(lower + 1));
    };
    return between(0) & between(1) & between(2);
}

/// Mask from a test of each of the first `count` lanes; out of the way of the common case, where no lane differs.
template <class Test>
[[gnu::noinline]] LaneMask lanes_where(const Test& test, int count)
{
    LaneMask mask{};
    for (int i = 0; i < count; ++i) mask.v[i] = test(i) ? -1 : 0;
    return mask;
}

/// The flags of a whole chunk as one number.
inline std::uint64_t packed_flags(const std::uint8_t* flags)
{
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, flags, Lanes::lanes);
    return bytes;
}

inline bool any_set(const std::uint8_t* flags, int count)
{
    if (count == Lanes::lanes) return packed_flags(flags) != 0;
    std::uint8_t any = 0;
    for (int i = 0; i < count; ++i) any = static_cast<std::uint8_t>(any | flags[i]);
    return any != 0;
}

/// The first `count` flags are equal.
inline bool all_equal(const std::uint8_t* flags, int count)
{
    if (count == Lanes::lanes) {
        constexpr std::uint64_t ones = 0x0101010101010101 >> (64 - 8 * Lanes::lanes);
        return packed_flags(flags) == flags[0] * ones;
    }
    bool same = true;
    for (int i = 1; i < count; ++i) same = same && flags[i] == flags[0];
    return same;
}

/// None of `count` particles has decohesion state.
inline bool none_cracked(const std::int32_t* crack, int count)
{
    std::int32_t all = -1; // the sign bit survives only if every index is negative
    for (int i = 0; i < count; ++i) all &= crack[i];
    return all < 0;
}

/// Whom a visit to a cell serves.
enum class Visitors
{
    residents, // the particles stored under the cell that have not left it
    stray,     // one particle that is stored elsewhere
    everyone,  // all particles stored under the cell (gimp)
};

/// Particles of a plain cell at most: functions with `Plain` set know that every lane is a particle at home, that one
/// law serves all and nobody has decohesion state.
inline constexpr int largest_plain = 8;

/// Particles of a plain cell, [begin, end); with long vectors the compiler knows how many.
inline std::size_t plain_count(std::size_t begin, std::size_t end)
{
    return Lanes::lanes == largest_plain ? largest_plain : end - begin;
}

/// Particles of a cell worked on together at most; in cells that are not plain, more hardly ever meet, and if they do
/// each group has means of its own.
template <bool Plain>
inline constexpr std::size_t group_size = Plain ? largest_plain : 64;

/// Whole chunks of particles, all at home, and no more than a plain cell holds.
/// @pre begin < end
inline bool all_at_home(const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    if (end - begin > largest_plain || (end - begin) % Lanes::lanes != 0) return false;
    for (std::size_t p = begin; p < end; p += Lanes::lanes)
        if (any_set(particles.away.data() + p, Lanes::lanes)) return false;
    return true;
}

/// Most cells of most steps are plain; with short vectors cells filled by half are, too.
/// @pre begin < end
inline bool is_plain(const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    if (!all_at_home(particles, begin, end)) return false;
    for (std::size_t p = begin; p < end; p += Lanes::lanes)
        if (!all_equal(particles.material.data() + p, Lanes::lanes) ||
            particles.material[p] != particles.material[begin])
            return false;
    return particles.cracks.empty() || none_cracked(particles.crack.data() + begin, static_cast<int>(end - begin));
}

/// Every lane.
inline LaneMask all_lanes()
{
    const Lanes zero(Real(0));
    return zero >= zero;
}

/// Lanes to serve among the first `count`. In the total formulation nobody ever leaves.
template <Formulation F, bool Plain = false>
[[gnu::always_inline]] inline LaneMask present(Visitors visitors, const particles::Particles& particles,
                                               std::size_t begin, int count)
{
    if constexpr (Plain) return all_lanes();
    LaneMask mask = core::first_lanes<Real, Lanes::lanes>(count);
    if constexpr (F == Formulation::updated) {
        if (visitors == Visitors::residents && any_set(particles.away.data() + begin, count))
            return mask &
                   !lanes_where([&](int i) { return particles.away[begin + static_cast<std::size_t>(i)] != 0; }, count);
    }
    return mask;
}

/// Material constants per lane.
struct LawLanes
{
    Lanes lame, shear, yield, hardening, per_overstress, tensile_onset, shear_onset;
    LaneMask averaged;
};

/// Lanes of several materials in one cell.
[[gnu::noinline]] inline void mix_laws(const LawTable& laws, const std::uint8_t* index, int count, LawLanes& lanes)
{
    for (int i = 1; i < count; ++i) {
        const LawConstants& d = laws.constants[index[i]];
        lanes.lame.v[i] = d.lame;
        lanes.shear.v[i] = d.shear;
        lanes.yield.v[i] = d.yield;
        lanes.hardening.v[i] = d.hardening;
        lanes.per_overstress.v[i] = d.per_overstress;
        lanes.tensile_onset.v[i] = d.tensile_onset;
        lanes.shear_onset.v[i] = d.shear_onset;
        lanes.averaged.v[i] = d.averaged_dilatation ? -1 : 0;
    }
}

template <bool Plain = false>
[[gnu::always_inline]] inline LawLanes law_lanes(const LawTable& laws, const particles::Particles& particles,
                                                 std::size_t begin, int count)
{
    const std::uint8_t* index = particles.material.data() + begin;
    const LawConstants& c = laws.constants[index[0]];
    const Lanes zero(Real(0));
    LawLanes lanes{Lanes(c.lame),           Lanes(c.shear),
                   Lanes(c.yield),          Lanes(c.hardening),
                   Lanes(c.per_overstress), Lanes(c.tensile_onset),
                   Lanes(c.shear_onset),    c.averaged_dilatation ? all_lanes() : zero < zero};
    if (Plain || all_equal(index, count)) return lanes;
    mix_laws(laws, index, count, lanes);
    return lanes;
}

/// Lanes of particles without decohesion state.
template <bool Plain = false>
[[gnu::always_inline]] inline LaneMask intact(const particles::Particles& particles, std::size_t begin, int count)
{
    if constexpr (Plain) return all_lanes();
    const std::int32_t* crack = particles.crack.data() + begin;
    if (none_cracked(crack, count)) return all_lanes();
    return !lanes_where([&](int i) { return crack[i] >= 0; }, count);
}
} // namespace transfer
