/// Make the leaf cells fit the particles: refine, split, build the leaves, order the particles.
#pragma once

#include "grid/levels.h"
#include "grid/refinement.h"
#include "particles/particles.h"
#include "transfer/scheme.h"

namespace refine
{
/// Cells that hold a particle whose zone asked for a finer level are subdivided, so that refinement moves with the
/// material (methods.md A.3.6); balanced. Children of a split keep the target level of their parent, so the fine region
/// does not grow by itself.
grid::Refinement refinement_from_targets(const grid::Levels& levels, const particles::Particles& particles);

/// Split particles that sit in cells finer than they are, until none does.
/// @return number of particles that were split
std::size_t split_into_finer_cells(const grid::Levels& levels, const grid::Refinement& refinement, int per_axis,
                                   particles::Particles& particles);

/// Build the leaves for the present cells and order the particles by (level, leaf, cell, id).
///
/// @param formulation  total: cells of rest positions; updated: of current positions
/// @param levels       reads spacing0, count, origin; everything else is rebuilt
/// @param particles    all columns reordered, `away` cleared
/// @error core::NumericalError if a position is not finite, naming the particle
void order(transfer::Formulation formulation, const grid::Refinement& refinement, grid::Levels& levels,
           particles::Particles& particles);
} // namespace refine
