/// Fill the leaf cells of a refinement with the particles of a body.
#pragma once

#include "particles/seed.h"
#include "refine/zone.h"

namespace refine
{
/// @param per_axis   particles per cell and axis, on every level
/// @param particles  appended in cell order of level 0, children inside their parent
void populate(const geometry::Shape& shape, const particles::SeedTraits& traits, const Lattice& lattice,
              const grid::Refinement& refinement, int per_axis, particles::Particles& particles);
} // namespace refine
