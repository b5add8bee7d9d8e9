/// Discontinuous bifurcation: when the elastoplastic tangent of von Mises first admits a jump of the strain rate across
/// a plane, det(n . C_ep . n) = 0 (Rice 1976; Yang et al. 2014 compare their strength criterion with it).
///
/// With the unit deviator d (principal values d_1 >= d_2 >= d_3) and the plastic modulus H,
///   C_ep = C - 6 mu^2 / (3 mu + H) d (x) d,
///   det(n . C_ep . n) / det(n . C . n) = 1 - 6 mu / (3 mu + H) [|d n|^2 - (n . d n)^2 / (2 (1 - nu))].
/// The bracket is concave in n_i^2 and its maximum lies in the plane of d_1 and d_3:
///   min over n = 1 - 3 mu / (3 mu + H) [1 - (1 + nu) d_2^2]   at   n . d n = -(1 - nu) d_2.
/// So with H > 0 the tensor is never singular; with H = 0 only where d_2 = 0 (plane strain, pure shear), on the planes
/// at 45 degrees of the shear criterion; any other state needs softening, H <= -3 mu (1 + nu) d_2^2.
#pragma once

#include "core/tensor.h"
#include "material/material.h"

namespace material
{
/// The plane that comes closest to bifurcation.
struct Bifurcation
{
    double ratio = 1;              // 1, least det(n . C_ep . n) / det(n . C . n); <= 0: bifurcation
    core::Vec<double> normal{};    // 1, of that plane; its conjugate has n_3 reversed
    double critical_hardening = 0; // MPa, H at which the ratio would be zero
};

/// Acoustic tensor of plastic loading.
/// @param stress           MPa, on the yield surface, not hydrostatic
/// @param plastic_modulus  MPa, H > -3 mu
Bifurcation bifurcation(const Elastic& elastic, double plastic_modulus, const core::Sym<double>& stress);
} // namespace material
