/// Onset of decohesion after Yang et al. 2014: when a particle begins to separate, on which plane, how strong, how
/// tough.
///
///   opening s_1 > s_max only, shear (s_1 - s_3)/2 > tau(L) only, mixed both;       c_m = tau_tf / tau_nf
///   tau(L) = tau_max + (tau_max_axial - tau_max) L^2,   L = (2 s_2 - s_1 - s_3) / (s_1 - s_3)
///   tau_nf = sqrt(<tau_n>^2 + tau_t^2 / c_m^2),   tau_tf = c_m tau_nf              (F = 0 at onset)
///   L_e = c_b h (|n_x| + |n_y| + |n_z|),   U_0 = G_f (q + 1) / q  or  u_0 tau_0
///
/// The readings of the paper behind these lines, with their numbers, are in docs/decohesion.md. What happens after
/// onset is in material/separation.h. Cold code: one particle at a time, after material::may_start.
#pragma once

#include "core/crack.h"
#include "core/tensor.h"
#include "material/crack_plane.h"
#include "material/material.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace material
{
/// Tractions on a plane: normal, tension positive, and magnitude of the tangential part.
struct PlaneTraction
{
    double normal = 0; // MPa, tau_n
    double shear = 0;  // MPa, |tau_t|
};

PlaneTraction plane_traction(const core::Sym<double>& stress, const core::Vec<double>& normal);

/// 1 - lambda^q [1], the part of the strength left.
inline double strength_left(double q, double damage)
{
    return q == 1 ? 1 - damage : 1 - std::pow(damage, q);
}

/// Loading phi [1] of a traction on the crack's plane or another: sqrt((<tau_n>/tau_nf)^2 + (|tau_t|/tau_tf)^2), which
/// the crack softens at when it is `strength_left`.
double loading(const core::Crack& crack, const PlaneTraction& traction);

/// Shear strength of uniaxial tension over that of shear [MPa]; 0 where the law makes no difference.
/// @pre  tau_max is finite where tau_max_axial is given
inline double axial_rise(const Decohesion& law)
{
    return law.tau_max_axial ? *law.tau_max_axial - law.tau_max : 0;
}

/// The least shear strength of all states [MPa].
inline double least_shear_strength(const Decohesion& law)
{
    return law.tau_max + std::min(axial_rise(law), 0.0);
}

/// The cheap test of material/onset.h with the strengths of a law: false where no criterion can be met.
bool may_start(const Decohesion& law, const core::Sym<double>& stress);

/// Lode parameter of a stress [1].
double lode_parameter(const Principal& stress);

/// How far a stress exceeds the criteria [1]: the largest ratio of stress to strength, s_1 / s_max or
/// (s_1 - s_3) / (2 tau(L)); above 1 where failing_mode names one.
/// @param lode  1, L of the strength
double onset_ratio(const Decohesion& law, const Principal& stress, double lode);
/// The same on a plane that is given: sigma_n / s_max or |tau_t| / tau_max.
double onset_ratio(const Decohesion& law, const PlaneTraction& traction);

/// Mode that a stress starts, by the three criteria of the paper; none while both strengths hold.
/// @param lode  1, L of the strength
std::optional<Mode> failing_mode(const Decohesion& law, const Principal& stress, double lode);

/// The same on a given plane: tension beyond s_max opens it, shear beyond tau_max shears it.
std::optional<Mode> failing_mode(const Decohesion& law, const PlaneTraction& traction);

/// State of a new crack (damage 0), or nothing if the strengths hold. The stress itself is not changed in this step.
///
/// @param test_stress  MPa, after the return to the yield surface: decides mode and plane (the particle's own, or its
///                     cell's mean where law.smoothed_onset)
/// @param stress       MPa, the particle's own; strengths are the larger of the two stresses' tractions, so F <= 0
/// @param bias         velocity gradient and nearest crack, for the choice between conjugate planes
/// @param spacing      mm, of the leaf cell the particle is in
/// @param time         ms
/// @param lode         1, L of the shear strength; empty: that of test_stress
/// @pre  law gives u0 or a fracture energy; law.q > 0
/// @cost about 1 us, no allocation
std::optional<core::Crack> onset(const Decohesion& law, const Elastic& elastic, const core::Sym<double>& test_stress,
                                 const core::Sym<double>& stress, const Bias& bias, double spacing, double time,
                                 std::optional<double> lode = {});

/// Longest effective length [mm] that softens without snap-back under prescribed strain (methods.md D.6),
///   L_crit = U_0 [M (tau_n/tau_nf)^2 / tau_nf^2 + mu (tau_t/tau_tf)^2 / tau_tf^2] / (phi^2 q),
/// 2 M G_f / tau_nf^2 in opening and 2 mu G_f / tau_tf^2 in shear for q = 1. Reads strengths and surface energy of
/// `crack`; <tau_n> counts. For q < 1 the start of softening always snaps back: this is the value at full separation.
/// @pre some traction that loads the plane
double critical_length(const Elastic& elastic, double q, const core::Crack& crack, const PlaneTraction& traction);

/// Fracture energy G_f = U_0 q / (q + 1) [N/mm] that the crack will dissipate, in any mode and on any path (D.4) that
/// does not snap back: a brittle drop, and a crack that separates in one step, dissipate otherwise.
double fracture_energy(double q, const core::Crack& crack);

/// What softening has dissipated so far, U_0 (lambda - lambda^(q+1) / (q+1)) [N/mm], on any such path: the
/// integral of tau.du = U_0 (1 - lambda^q) dlambda. G_f once the crack is through.
double softening_energy(double q, const core::Crack& crack);
} // namespace material
