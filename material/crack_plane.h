/// Orientation of a new decohesion plane from the principal stresses (methods.md D.2 item 4, D.11 items 10 and 11).
///
///   opening  n = n_1                                        (11)
///   shear    n = (n_1 - n_3) / sqrt 2, 45 degrees           (12)
///   mixed    n = (n_1 + n_II) / |n_1 + n_II|, 22.5 degrees  (13)
///
/// Eigenvectors have no sign, so (12) and (13) have a conjugate with n_3 reversed, and equal principal stresses leave a
/// whole family of planes. Both choices follow the motion: the plane across which the velocity changes most wins.
/// Equation numbers: Yang et al. 2014.
#pragma once

#include "core/tensor.h"
#include "material/principal.h"

#include <cstdint>

namespace material
{
/// How a particle begins to separate; the numbers are those of core::Crack::mode.
enum class Mode : std::int32_t
{
    opening = 1,
    shear = 2,
    mixed = 3,
};

/// What orients a plane besides the stress.
struct Bias
{
    core::Mat<double> velocity_gradient; // 1/ms, L
    core::Vec<double> preferred_normal;  // 1, unit normal of the nearest crack within 2 L_e; zero: none
};

/// Principal stresses within this share of the largest magnitude count as equal (D.11 item 11).
inline constexpr double equal_stress_tolerance = 1e-6;
/// |L n| of two candidates within this share count as equal: the velocity gradient of a particle is not known better.
inline constexpr double equal_rate_tolerance = 1e-2;

/// Unit normal of the plane. Candidates are ranked by |L n|, then by closeness to the preferred normal, then the one
/// of (12), (13) with the fixed signs of material/principal.h.
core::Vec<double> crack_normal(Mode mode, const Principal& stress, const Bias& bias);
} // namespace material
