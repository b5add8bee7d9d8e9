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
struct PassOptions; // transfer/passes.h

struct Strays
{
    std::vector<std::uint32_t> particle; // sorted by (leaf, particle)
    std::vector<std::int32_t> leaf;      // [s] leaf the particle is in now
    std::vector<std::int32_t> cell;      // [s] cell of that leaf
    std::vector<std::uint32_t> run;      // starts of equal-leaf runs, + 1 entry
    bool outside = false;                // one of them is where no cell can be made active: reorder before use
    grid::Refinement refinement{1};      // where the leaf cells are: ancestors of active cells
    Boxes boxes;                         // basis gimp; positions of the last scatter

    std::size_t size() const { return particle.size(); }
};

/// Are there so many strays that reordering all particles is cheaper than serving them, or are they where none can be
/// served (docs/performance.md)?
bool worth_reordering(const PassOptions& options, const Strays& strays, const particles::Particles& particles);

/// Find leaf and cell of the particles in `away` (unsorted, no repeats). Points that enter an empty cell, as fine as
/// their target asks for, make it active where that is easy (grid::activate): a body that moves does so at every other
/// step. Throws core::NumericalError naming the particle if a position is not finite.
void assign(const PassOptions& options, const std::vector<std::uint32_t>& away, const particles::Particles& particles,
            grid::Levels& levels, Strays& strays);

/// The same for every particle marked away, in the hierarchy of the active cells alone, so that a restart finds the
/// same cells: after an ordering or a restart.
void assign_all(const PassOptions& options, const particles::Particles& particles, grid::Levels& levels,
                Strays& strays);
} // namespace transfer
