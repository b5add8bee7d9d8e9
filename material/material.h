/// What a case says about a material: plain parameters, units mm-g-ms (MPa, N, mJ).
#pragma once

#include "core/real.h"

#include <array>
#include <optional>
#include <string>

namespace material
{
/// Isotropic elasticity.
struct Elastic
{
    Real density = 0;        // g/mm^3
    Real youngs_modulus = 0; // MPa
    Real poisson_ratio = 0;  // 1

    Real shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
    Real bulk_modulus() const { return youngs_modulus / (3 * (1 - 2 * poisson_ratio)); }
    Real lame() const { return bulk_modulus() - 2 * shear_modulus() / 3; }
    /// P-wave modulus M = lambda + 2 mu.
    Real wave_modulus() const { return lame() + 2 * shear_modulus(); }
    /// Dilatational wave speed c_d [mm/ms].
    Real wave_speed() const;
};

/// von Mises with linear isotropic hardening; E_T is read as the tangent modulus d(sigma)/d(epsilon).
struct VonMises
{
    Real yield_stress = 0;    // MPa
    Real tangent_modulus = 0; // MPa
    /// Plastic modulus H = E E_T / (E - E_T) (methods.md D.2, 10).
    Real plastic_modulus(Real youngs_modulus) const
    {
        return youngs_modulus * tangent_modulus / (youngs_modulus - tangent_modulus);
    }
};

/// What happens when L_e exceeds the snap-back length L_crit (methods.md D.7).
enum class SnapBack
{
    energy_floor, // S2: raise the fracture energy to kappa tau^2 L_e / (2 Q)
    brittle_drop, // S4: linear decay of the tractions over k L_e / c_d
};

enum class OnsetStrength
{
    plane, // tractions on the chosen plane: F = 0 at onset
    paper, // eq. (10) of the paper, tractions that do not coexist on the plane
};

/// Decohesion after Yang et al. 2014 in the reading of methods.md D. One of two ways to give the energy: the paper's
/// reference decohesion u0, or the fracture energies of the two modes.
struct Decohesion
{
    Real s_max = 0;   // MPa, tensile strength on s1; infinity: never mode I
    Real tau_max = 0; // MPa, shear strength on (s1 - s3) / 2 in plane strain; infinity: never mode II
    /// MPa, the same where two principal stresses are equal, as in a tension bar; empty: tau_max.
    std::optional<Real> tau_max_axial;
    /// 1, plastic strain over which the shear strength of an onset forgets the state before; 0: that of the moment.
    Real lode_memory = 0;
    Real q = 1;                   // 1, exponent of the softening law
    std::optional<Real> u0;       // mm, reference decohesion (preset paper)
    std::optional<Real> energy_1; // N/mm, G_fI
    std::optional<Real> energy_2; // N/mm, G_fII
    Real c_m_opening = 100;       // 1, c_m = tau_tf / tau_nf of a mode I onset
    Real c_m_shear = 0.01;        // 1, of a mode II onset
    Real c_m_mixed = 1;           // 1, of a mixed onset
    Real band_factor = 1;         // 1, c_b in L_e = c_b h sum |n_i|
    SnapBack snap_back = SnapBack::energy_floor;
    Real energy_floor_factor = 1.2; // 1, kappa of S2
    Real drop_transits = 8;         // 1, k of S4
    OnsetStrength onset_strength = OnsetStrength::plane;
    bool smoothed_onset = true; // test the onset on the cell mean of the stress
    Real nonlocal_radius = 0;   // mm, test it on the mean over a ball instead (transfer/nonlocal_onset.h); 0: off
    Real crack_exclusion = 0;   // mm, with a ball: no second crack plane this close beside a parallel one; 0: none
    /// 1, unit normal of the only plane that can break (a weld, a bond, a side groove), in space at onset; empty: the
    /// stress decides.
    std::optional<std::array<Real, 3>> weak_plane;
    Real rotating_until = 0;    // 1, damage until which the plane of an opening crack follows the strain; 0: fixed
    bool renewed_plane = false; // a softening crack goes on where the stress reaches its strength again
    bool second_crack = false;  // stress along an open crack that reaches a strength lets go
    Real friction = 0;          // 1, Coulomb coefficient of a closed crack
};

struct Material
{
    std::string name;
    Elastic elastic;
    std::optional<VonMises> plastic;
    std::optional<Decohesion> decohesion;
    bool cell_averaged_dilatation = true; // against volumetric locking (methods.md B8)
};
} // namespace material
