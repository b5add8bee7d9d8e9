/// Lane functions of the onset: the shear strength of a state, and a cheap test that comes before material::onset.
///
/// Can this stress reach a decohesion strength at all? Without eigenvalues, for every stress (p mean stress, J2 second
/// invariant of the deviator):
///   (s_1 - s_3) / 2 <= sqrt(J2)   and   s_1 <= p + 2/sqrt(3) sqrt(J2),
/// with equality in pure shear and in uniaxial tension. A stress the test clears cannot start a crack; a flagged one
/// may still not, because (s_1 - s_3) / 2 can be as small as sqrt(3)/2 sqrt(J2).
#pragma once

#include "core/simd.h"
#include "core/tensor.h"

namespace material
{
/// Lode parameter L [1] = (2 s_2 - s_1 - s_3) / (s_1 - s_3) of principal values s_1 >= s_2 >= s_3: -1 in uniaxial
/// tension, 0 in shear and in plane strain of a metal that flows, 1 in uniaxial compression; 0 where all are equal.
template <class T>
constexpr T lode_parameter(const T& s1, const T& s2, const T& s3)
{
    const T spread = s1 - s3;
    return core::select(spread > T(0), (s2 - s1 + (s2 - s3)) / spread, T(0));
}

/// Shear strength tau(L) [MPa] = tau_max + axial_rise L^2, even and quadratic in L as the symmetric fracture locus of
/// Bai & Wierzbicki (Int. J. Plast. 24, 2008).
/// @param axial_rise  MPa, strength of a tension bar over tau_max
template <class T>
constexpr T shear_strength(const T& lode, double tau_max, double axial_rise)
{
    return T(tau_max) + T(axial_rise) * lode * lode;
}

/// Truth value per lane: the particle needs the exact test of material/decohesion.h. Infinite strengths never flag.
/// @param stress  MPa; s_max, tau_max MPa, tau_max >= 0; where the shear strength hangs on the state, the least
template <class T>
constexpr auto may_start(const core::Sym<T>& stress, const T& s_max, const T& tau_max) -> decltype(s_max < tau_max)
{
    // Rounding may not clear what the exact test would start: flag a little early (float lanes included).
    const T early = T(1 - 1e-5);
    const T mean = core::trace(stress) * T(1.0 / 3.0);
    const T s0 = stress[0] - mean, s1 = stress[1] - mean, s2 = stress[2] - mean;
    const T shear = stress[3] * stress[3] + stress[4] * stress[4] + stress[5] * stress[5];
    const T j2 = T(0.5) * (s0 * s0 + s1 * s1 + s2 * s2) + shear;
    const T shear_limit = early * tau_max;
    const T tension_left = early * s_max - mean; // beyond s_max by the mean stress alone where negative
    return (j2 > shear_limit * shear_limit) | (tension_left < T(0)) | (T(4.0 / 3.0) * j2 > tension_left * tension_left);
}
} // namespace material
