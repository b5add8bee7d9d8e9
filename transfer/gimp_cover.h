/// Cells for the boxes of the basis `gimp`: every cell that a box reaches must be active, whether a particle sits in it
/// or not (docs/decisions/011).
#pragma once

#include "transfer/gimp_box.h"

namespace transfer
{
/// How far boxes may move before new cells are needed, in cells of their size. About as far as particles move until a
/// share of them has changed cells that is worth an ordering (strays.cpp), so neither forces an ordering much more
/// often than the other.
inline constexpr Real box_margin = 0.05;

/// Subdivide coarse cells that hold no particle and are reached by boxes of finer ones, and balance. Otherwise fine
/// free surfaces would hang on coarse nodes that carry nothing else (docs/decisions/004).
/// @param levels  reads spacing0, count, origin
void refine_voids(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                  grid::Refinement& refinement);

/// Activate all cells that boxes, grown by box_margin, reach.
/// @param levels  ordered for the particles; rebuilt with more cells, cell_start follows
void cover_boxes(const PassOptions& options, const grid::Refinement& refinement, const particles::Particles& particles,
                 grid::Levels& levels);
} // namespace transfer
