/// The passes of transfer/passes.h for the basis `gimp` (updated formulation); those dispatch here.
///
/// A leaf serves the particles stored under it: nearly all of them through tiles that hold all nodes in reach
/// (gimp_reach.h), by weights in closed form (gimp_weights.h); boxes that touch cells of other levels, or that have
/// gone far, by cutting them (gimp_box.h). Nodes of other leaves get their share in a second loop, `deliver`, in a
/// fixed order. So results do not depend on the number of threads. Particles that have left their home cell are treated
/// like the others, except that they take no part in the means over it.
#pragma once

#include "transfer/passes.h"

namespace transfer
{
void scatter_boxes(const PassOptions& options, const LawTable& laws, Strays& strays,
                   const particles::Particles& particles, grid::Levels& levels);

struct LeafOutcome;

/// Advance the particles of every leaf and add them to the leaf's own sums.
void advance_boxes(const PassOptions& options, const LawTable& laws, Strays& strays, particles::Particles& particles,
                   grid::Levels& levels, std::vector<LeafOutcome>& outcome);

/// Give the other leaves theirs, after the onsets of `outcome` have been recorded.
/// @param strays  may become `outside`
void finish_boxes(const PassOptions& options, const LawTable& laws, const std::vector<LeafOutcome>& outcome,
                  Strays& strays, const particles::Particles& particles, grid::Levels& levels);

void remap_boxes(const PassOptions& options, Strays& strays, particles::Particles& particles, grid::Levels& levels);

/// Room for the boxes of all leaves.
void prepare_boxes(const grid::Levels& levels, Boxes& boxes);

/// Sums of one leaf's particles: into its own tile, its skin and its list of cut boxes. Never inlined into a pass, so
/// that every caller gets the same bits.
struct ReachMap;
void scatter_leaf_boxes(const PassOptions& options, const LawTable& laws, const grid::Refinement& refinement,
                        const particles::Particles& particles, std::size_t leaf, const ReachMap& map,
                        grid::Levels& levels, Boxes& boxes);

/// Sort the parts of cut boxes by the leaves they lie in. Notes in `strays` if some are missing.
void sort_arrivals(Strays& strays);

/// Add to every leaf what the others have for it.
void deliver_boxes(const PassOptions& options, const Boxes& boxes, grid::Levels& levels);
} // namespace transfer
