/// One step of a particle that has begun to separate: softening, full separation, closure (methods.md D.3, D.8, D.12).
///
/// Loading surface F = U_0 [phi - (1 - lambda^q)] <= 0 with phi^2 = (<tau_n>/tau_nf)^2 + (|tau_t|/tau_tf)^2. With a
/// trial traction outside, opening du relaxes the strain that spreads it over L_e, tau = tau^tr - Q du / L_e, Q =
/// diag(M, mu, mu), and the new damage is the smallest root of
///
///   sum_i (tau_i^tr/tau_if)^2 / (g + b_i d_lambda)^2 = 1,  g = 1 - (lambda + d_lambda)^q,  b_i = Q_i U_0 / (tau_if^2
///   L_e);
///
/// without a root the particle separates in this step (snap-back). Dissipation is the trapezoid of traction and opening
/// and sums to U_0 q/(q+1) per crack area on every stable path. Compression passes and loads nothing. No plastic flow
/// from the onset until lambda = 1. Neglected: closure of a partly opened crack, wear.
#pragma once

#include "core/crack.h"
#include "core/tensor.h"
#include "material/elastic.h"
#include "material/von_mises.h"

#include <optional>

namespace material
{
/// Constants of `separate`, computed once per material.
struct SeparationLaw
{
    LameConstants<double> lame{};
    double wave_modulus = 0;                         // MPa, M
    double shear_modulus = 0;                        // MPa, mu
    std::optional<PlasticConstants<double>> plastic; // empty: elastic
    double q = 1;                                    // 1, exponent of softening
    double drop_speed = 0;                           // mm/ms, c_d / k: brittle ramp; 0: the softening law always
    double rotating_until = 0;                       // 1, damage up to which an opening crack follows the strain
    bool renewed_plane = false;                      // a softening crack goes on where the stress reaches its strength
    double friction = 0;                             // 1, Coulomb coefficient of a closed crack
    bool second_crack = false;                       // stress along an open crack lets go at these strengths
    double second_tension = 0;                       // MPa
    double second_shear = 0;                         // MPa
    double axial_rise = 0;                           // MPa, of the shear strength where the state is that of a bar
};

/// @pre material.decohesion is set
SeparationLaw separation_law(const Material& material);

/// What happens to the particle in the step.
struct StrainStep
{
    core::Sym<double> stress;     // MPa, at the beginning, not yet rotated
    core::Sym<double> strain;     // 1, increment
    core::Vec<double> spin;       // 1, of the material (material/rotation.h)
    double eq_plastic_strain = 0; // 1, at the beginning
    double dt = 0;                // ms
    double time = 0;              // ms, end of the step
};

struct DecohesionStep
{
    core::Sym<double> stress;     // MPa, at the end
    core::Crack crack;            // normal and slip rotated, damage and opening advanced
    double eq_plastic_strain = 0; // 1
    double decohesion_work =
        0; // mJ/mm^3, dissipated by opening, slip, friction and second cracks, and what turning the plane frees; >= 0
    double plastic_work = 0; // mJ/mm^3
};

/// Advance a crack of any damage by one step. The plane of an opening crack is turned first while lambda <
/// rotating_until (material/rotating_crack.h), and that of a crack that still softens is chosen again afterwards where
/// the law has renewed_plane (material/renewed_plane.h).
///
/// lambda < 1: the equations above, or, where the law asks for the brittle drop and the crack is in snap-back,
/// tractions bounded by (1 - lambda) times those at onset with d_lambda = dt c_d / (k L_e). lambda = 1: the crack opens
/// and slips without resistance and closes again on compression (friction optional); the rest of the stress is returned
/// to the yield surface.
/// @pre  strengths, effective_length, surface_energy > 0, as material::onset sets them
/// @cost 100 to 200 ns, no allocation, no eigenvalues
DecohesionStep separate(const SeparationLaw& law, const core::Crack& crack, const StrainStep& step);

/// Increment of damage for the trial loading x_i = tau_i^tr / tau_if >= 0 outside the loading surface; the whole rest
/// 1 - damage where no root exists. `stiffness` holds b_i.
double damage_increment(double q, double damage, const std::array<double, 2>& loading,
                        const std::array<double, 2>& stiffness);
} // namespace material
