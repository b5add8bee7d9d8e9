/// Isotropic linear elasticity as an increment: sigma^tr = sigma + lambda tr(d_eps) I + 2 mu d_eps (methods.md D.3).
///
/// T is double or a core::Pack of lanes (one particle per lane).
#pragma once

#include "core/tensor.h"
#include "material/material.h"

namespace material
{
/// Lame constants, ready for the kernels.
template <class T>
struct LameConstants
{
    T lame;      // MPa, lambda
    T shear_two; // MPa, 2 mu
};

template <class T>
LameConstants<T> lame_constants(const Elastic& elastic)
{
    return {T(elastic.lame()), T(2 * elastic.shear_modulus())};
}

/// Trial stress [MPa] of the strain increment [1] on top of `stress` [MPa], already rotated (material/rotation.h).
template <class T>
constexpr core::Sym<T> elastic_trial(const core::Sym<T>& stress, const core::Sym<T>& strain_increment,
                                     const LameConstants<T>& elastic)
{
    const core::Sym<T>& e = strain_increment;
    const T volumetric = elastic.lame * core::trace(e);
    return {{stress[0] + (volumetric + elastic.shear_two * e[0]), stress[1] + (volumetric + elastic.shear_two * e[1]),
             stress[2] + (volumetric + elastic.shear_two * e[2]), stress[3] + elastic.shear_two * e[3],
             stress[4] + elastic.shear_two * e[4], stress[5] + elastic.shear_two * e[5]}};
}

/// Stored energy per volume [mJ/mm^3] of an isotropic elastic stress [MPa]: p^2 / (2 K) + J2 / (2 mu), K = lambda + 2/3
/// mu.
template <class T>
constexpr T stored_energy(const T& lame, const T& shear, const core::Sym<T>& stress)
{
    const T mean = core::trace(stress) * T(1.0 / 3.0), half(0.5);
    core::Sym<T> deviator = stress;
    for (int a = 0; a < 3; ++a) deviator[a] -= mean;
    const T bulk = lame + shear * T(2.0 / 3.0);
    return half * mean * mean / bulk + half * half * core::contract(deviator, deviator) / shear;
}

/// The same for the constants of a case.
double elastic_energy(const Elastic& elastic, const core::Sym<double>& stress);
} // namespace material
