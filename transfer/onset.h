/// A particle that begins to separate in this step; it softens from the next one on (methods.md D.11, 14).
#pragma once

#include "particles/particles.h"

#include <cstdint>

namespace transfer
{
struct Onset
{
    std::uint32_t particle = 0;
    core::Crack crack;
};

/// Give the particle its entry in the side table.
inline void record(const Onset& onset, particles::Particles& particles)
{
    particles.crack[onset.particle] = static_cast<std::int32_t>(particles.cracks.size());
    particles.cracks.push_back(onset.crack);
}
} // namespace transfer
