/// Reorder all columns at once.
#pragma once

#include "particles/particles.h"

#include <span>

namespace particles
{
/// Particle n of the result is particle order[n] of the input; `order` may be shorter than the input (the rest is
/// dropped). Crack indices travel with their particle.
void reorder(std::span<const std::uint32_t> order, Particles& particles);
} // namespace particles
