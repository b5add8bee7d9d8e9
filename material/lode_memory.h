/// The Lode parameter a metal remembers (key `lode_memory`, docs/decisions/031): a mean over plastic strain that
/// forgets exponentially, dL_m / de = (L - L_m) / e_m.
///
/// The stress of a moment is also that of a wave, which turns it within a fraction of a microsecond; what a metal bears
/// hangs on how it was strained. Bai & Wierzbicki (Int. J. Plast. 24, 2008) take the mean over the whole plastic
/// strain; the memory here is finite, so that the metal ahead of a crack may come into another state.
#pragma once

#include <cmath>

namespace material
{
/// L_m after a plastic strain at constant L.
/// @param mean           1, L_m before
/// @param lode           1, Lode parameter of the stress
/// @param strain         1, equivalent plastic strain since; none changes nothing
/// @param memory         1, e_m, positive
inline double remembered_lode(double mean, double lode, double strain, double memory)
{
    return mean + (1 - std::exp(-strain / memory)) * (lode - mean);
}
} // namespace material
