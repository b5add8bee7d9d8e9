/// Equivalent stress of von Mises, for results: sqrt(3/2 s:s) of the deviator s.
#pragma once

#include "core/real.h"
#include "core/tensor.h"

#include <cmath>

namespace core
{
/// @param s  stress, MPa
inline Real equivalent_stress(const Sym<Real>& s)
{
    const Real xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
    return std::sqrt(Real(0.5) * (xy * xy + yz * yz + zx * zx) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}
} // namespace core
