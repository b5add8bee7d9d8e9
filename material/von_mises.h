/// Radial return of von Mises plasticity with linear isotropic hardening.
///
///   q = sqrt(3/2 s:s),  k = sigma_y + H eps_p,  d_eps_p = <q - k> / (3 mu + H),  s <- s (1 - 3 mu d_eps_p / q)
///
/// Implicit in the flow direction, exact for proportional loading. The plastic work of a step is the trapezoid
/// (k + H d_eps_p / 2) d_eps_p, so the work since the beginning is sigma_y eps_p + H eps_p^2 / 2 whatever the steps.
/// Source: Simo & Hughes 1998, box 3.1. Neglected: rate and temperature dependence, kinematic hardening.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "material/elastic.h"

namespace material
{
/// Constants of the return, computed once per material so that the kernel divides only once.
template <class T>
struct PlasticConstants
{
    T yield;          // MPa, sigma_y > 0
    T hardening;      // MPa, H
    T shear_three;    // MPa, 3 mu
    T per_overstress; // 1/MPa, 1 / (3 mu + H)
};

template <class T>
PlasticConstants<T> plastic_constants(const Elastic& elastic, const VonMises& plastic)
{
    const Real shear_three = 3 * elastic.shear_modulus();
    const Real hardening = plastic.plastic_modulus(elastic.youngs_modulus);
    return {T(plastic.yield_stress), T(hardening), T(shear_three), T(1 / (shear_three + hardening))};
}

template <class T>
struct PlasticStep
{
    core::Sym<T> stress; // MPa, on or inside the yield surface
    T eq_plastic_strain; // 1, after the step
    T work;              // mJ/mm^3, plastic work of the step
};

/// Return a trial stress [MPa] to the yield surface; one inside it stays as it is. One square root and one division
/// where a lane yields, none where all are elastic; what a lane gets does not depend on the others.
/// @pre yield + hardening * eq_plastic_strain > 0
template <class T>
constexpr PlasticStep<T> radial_return(const core::Sym<T>& trial, const T& eq_plastic_strain,
                                       const PlasticConstants<T>& plastic)
{
    const T mean = core::trace(trial) * T(1.0 / 3.0);
    const T s0 = trial[0] - mean, s1 = trial[1] - mean, s2 = trial[2] - mean;
    const T shear = trial[3] * trial[3] + trial[4] * trial[4] + trial[5] * trial[5];
    const T square = T(1.5) * (s0 * s0 + s1 * s1 + s2 * s2) + T(3) * shear;
    const T strength = plastic.yield + plastic.hardening * eq_plastic_strain;
    const auto yields = square > strength * strength;
    if (!core::any(yields)) return {trial, eq_plastic_strain, T(0)};
    // max(q, k) is q where there is flow and positive where there is none: no 0/0.
    const T bound = core::max(core::sqrt(square), strength);
    const T flow = (bound - strength) * plastic.per_overstress;
    const T scale = T(1) - plastic.shear_three * flow / bound;
    const auto returned = [&](const T& from, const T& to) { return core::select(yields, to, from); };
    return {{{returned(trial[0], mean + scale * s0), returned(trial[1], mean + scale * s1),
              returned(trial[2], mean + scale * s2), returned(trial[3], scale * trial[3]),
              returned(trial[4], scale * trial[4]), returned(trial[5], scale * trial[5])}},
            eq_plastic_strain + flow,
            flow * (strength + T(0.5) * plastic.hardening * flow)};
}
} // namespace material
