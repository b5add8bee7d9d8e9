/// About how many particles the bodies will get, before anything of that number is made.
#pragma once

#include "refine/coverage.h"

#include <vector>

namespace refine
{
inline constexpr Real most_particles = 4294967295.0; // ids have 32 bits

/// Cells of edge `cell` that the boxes around the bodies hold, not more than exist if bodies overlap.
Real cells_around(const std::vector<geometry::Shape>& bodies, Real cell);

/// Can the bodies get more than so many particles? Not if their boxes, all in cells of the finest level, hold fewer;
/// most scenes need no estimate.
bool may_exceed(const Scene& scene, Real particles);

/// Particles of each level: V / cell^3 * particles per cell, with the volumes V of the bodies where zones ask for that
/// level from 32^3 sample points of each body's bounds, so a zone is found to within their distance. Cells that grading
/// adds between levels are not counted.
/// @return 1 per level
/// @pre    bodies have bounds
std::vector<Real> estimated_particles(const Scene& scene);
} // namespace refine
