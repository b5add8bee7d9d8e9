/// About how many particles the bodies will get, before anything of that number is made.
#pragma once

#include "refine/coverage.h"

#include <vector>

namespace refine
{
inline constexpr Real most_particles = 4294967295.0; // ids have 32 bits

/// Particles of each level: V / cell^3 * particles per cell, with the volumes V of the bodies where zones ask for that
/// level from 32^3 sample points of each body's bounds, so a zone is found to within their distance. Cells that grading
/// adds between levels are not counted.
/// @return 1 per level
/// @pre    bodies have bounds
std::vector<Real> estimated_particles(const Scene& scene);
} // namespace refine
