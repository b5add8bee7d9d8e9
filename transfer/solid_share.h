/// How much of a separating particle's volume is still metal.
#pragma once

#include "core/crack.h"

namespace transfer
{
/// Solid volume over smeared volume: L_e / (L_e + <u_n>). The opening is void, but J counts it (methods.md B28);
/// without this factor the stress along an open crack would act on a cross-section that grows with the opening.
inline Real solid_share(const core::Crack& crack)
{
    return crack.effective_length / (crack.effective_length + (crack.opening > 0 ? crack.opening : Real(0)));
}
} // namespace transfer
