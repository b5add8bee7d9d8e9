/// Decohesion state of one particle: plain data that particles store and material laws advance.
///
/// It lives in core because {particles, material} are siblings that do not include each other.
#pragma once

#include "core/real.h"

#include <array>
#include <cstdint>

namespace core
{
/// Decohesion state of a particle that has begun to separate; kept apart so that intact metal pays nothing.
/// Symbols as in methods.md D: plane normal n, opening u = u_n n + u_t (tension positive), strengths tau_nf, tau_tf.
struct Crack
{
    std::array<Real, 3> normal{};        // 1, unit normal of the decohesion plane, current configuration
    Real damage = 0;                     // 1, lambda: 0 intact, 1 separated
    Real opening = 0;                    // mm, normal opening u_n
    std::array<Real, 3> slip{};          // mm, tangential opening u_t
    Real normal_strength = 0;            // MPa, tau_nf frozen at onset
    Real tangential_strength = 0;        // MPa, tau_tf frozen at onset
    Real effective_length = 0;           // mm, L_e of the plane
    Real surface_energy = 0;             // N/mm, U_0 used (after the snap-back policy)
    Real snap_back_ratio = 0;            // 1, B_s = L_e / L_crit, L_crit that of the onset before the policy
    Real onset_time = 0;                 // ms
    Real separation_time = -1;           // ms, -1 while damage < 1
    Real second_time = -1;               // ms, when a second crack crossed this one; -1: none did
    std::array<Real, 2> drop_traction{}; // MPa, <tau_n>, |tau_t| at onset for the brittle ramp
    std::int32_t mode = 0;               // 1 opening, 2 shear, 3 mixed
    std::uint32_t particle_id = 0;       // 1, id of the particle it belongs to
};
} // namespace core
