/// Numbers that look random and are the same on every machine and with every standard library.
#pragma once

#include "core/real.h"

#include <random>

namespace support
{
class Random
{
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    /// Uniform in [lower, upper).
    Real between(Real lower, Real upper)
    {
        return lower + (upper - lower) * static_cast<Real>(bits_() >> 11) * 0x1p-53;
    }
    Vec3 vector(Real lower, Real upper)
    {
        const Real x = between(lower, upper), y = between(lower, upper), z = between(lower, upper);
        return {x, y, z};
    }
    /// Whole number in [lower, upper].
    int whole(int lower, int upper)
    {
        return lower + static_cast<int>(bits_() % static_cast<std::uint64_t>(upper - lower + 1));
    }

private:
    std::mt19937_64 bits_;
};
} // namespace support
