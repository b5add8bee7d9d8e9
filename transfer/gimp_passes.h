/// The passes of transfer/passes.h for the basis `gimp` (updated formulation); those dispatch here.
///
/// A leaf gathers for the particles stored under it from any motion tile. On the way to the grid it adds the parts that
/// lie in its own tile; parts in other leaves are added by those leaves in a second loop (Visits), in a fixed order. So
/// results do not depend on the number of threads. Particles that have left their home cell are treated like the
/// others, except that they take no part in the means over it.
#pragma once

#include "transfer/passes.h"

namespace transfer
{
void scatter_boxes(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                   grid::Levels& levels, Strays& strays);

/// Without the scatter.
struct LeafOutcome;
void advance_boxes(const PassOptions& options, const LawTable& laws, const Strays& strays, const grid::Levels& levels,
                   particles::Particles& particles, std::vector<LeafOutcome>& outcome);

void remap_boxes(const PassOptions& options, const Strays& strays, particles::Particles& particles,
                 grid::Levels& levels);
} // namespace transfer
