/// Material constants in the form the kernels broadcast.
#pragma once

#include "core/real.h"
#include "material/material.h"
#include "material/separation.h"

#include <limits>
#include <vector>

namespace transfer
{
/// Yield stress of a material without plasticity: finite, so that the return needs no special case.
inline constexpr Real no_yield = 1e30;

/// J below which a particle leaves its cell's mean dilatation, total formulation (docs/decisions/008).
inline constexpr Real least_averaged_volume = 0.5;

struct LawConstants
{
    Real lame = 0;                                              // MPa
    Real wave_speed = 0;                                        // mm/ms, c_d
    Real shear = 0;                                             // MPa
    Real yield = no_yield;                                      // MPa
    Real hardening = 0;                                         // MPa, plastic modulus H
    Real per_overstress = 0;                                    // 1/MPa, 1 / (3 mu + H)
    Real tensile_onset = std::numeric_limits<Real>::infinity(); // MPa, s_max; infinite: no decohesion
    Real shear_onset = std::numeric_limits<Real>::infinity();   // MPa, the least
    bool averaged_dilatation = true;
};

/// All materials of a case, by the index stored with each particle.
struct LawTable
{
    std::vector<LawConstants> constants;
    std::vector<material::Material> materials;
    std::vector<material::SeparationLaw> separation; // [m], default where a material has no decohesion
    bool any_decohesion = false;
    Real nonlocal_radius = 0; // mm, smallest of the materials that test their onset over a ball; 0: none does
};

LawTable law_table(const std::vector<material::Material>& materials);
} // namespace transfer
