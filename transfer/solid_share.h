/// How much of a separating particle's volume is still metal.
#pragma once

#include "core/crack.h"
#include "core/simd.h"

namespace transfer
{
/// Solid volume over smeared volume: L_e / (L_e + <u_n>). The opening is void, but J counts it (methods.md B28);
/// without this factor the stress along an open crack would act on a cross-section that grows with the opening.
template <class T>
T solid_share(const T& effective_length, const T& opening)
{
    return effective_length / (effective_length + core::max(opening, T(Real(0))));
}

inline Real solid_share(const core::Crack& crack)
{
    return solid_share(crack.effective_length, crack.opening);
}
} // namespace transfer
