/// A particle that begins to separate in this step; it softens from the next one on (methods.md D.11, 14).
#pragma once

#include "core/crack.h"

#include <cstdint>

namespace transfer
{
struct Onset
{
    std::uint32_t particle = 0;
    core::Crack crack;
};
} // namespace transfer
