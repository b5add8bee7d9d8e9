/// Particles that have left the cell they are stored under (updated formulation only).
///
/// Particles are ordered by home cell. A particle that moves into another cell is served there one by one until the
/// next reordering; `worth_reordering` says when that costs more than reordering. In the total formulation there are
/// none.
#pragma once

#include "grid/levels.h"
#include "grid/refinement.h"
#include "particles/particles.h"
#include "transfer/gimp_part.h"

#include <cstdint>
#include <vector>

namespace transfer
{
struct Strays
{
    std::vector<std::uint32_t> particle; // sorted by (leaf, particle)
    std::vector<std::int32_t> leaf;      // [s] leaf the particle is in now
    std::vector<std::int32_t> cell;      // [s] cell of that leaf
    std::vector<std::uint32_t> run;      // starts of equal-leaf runs, + 1 entry
    bool outside = false;                // one of them is in a cell that does not exist yet: reorder before use
    grid::Refinement refinement{1};      // where the leaf cells are
    Boxes boxes;                         // basis gimp; positions of the last scatter

    std::size_t size() const { return particle.size(); }
};

/// Share of strays above which reordering all particles is cheaper than serving them (kernels.md 4).
inline constexpr Real reorder_share = 0.02;

bool worth_reordering(const Strays& strays, const particles::Particles& particles);

/// Find leaf and cell of the particles in `away` (unsorted, no repeats).
/// Throws core::NumericalError naming the particle if a position is not finite.
void assign(const std::vector<std::uint32_t>& away, const particles::Particles& particles, const grid::Levels& levels,
            Strays& strays);

/// The same for every particle marked away: after a restart.
void assign_all(const particles::Particles& particles, const grid::Levels& levels, Strays& strays);
} // namespace transfer
