/// The time step: a share `cfl` of the time a dilatational wave takes through the finest cell (methods.md A.6).
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
/// Steps between two estimates; the step is constant in between.
inline constexpr int time_step_interval = 32;

/// Share of (deformed cell width / wave speed) that the step may not exceed. A cell at a cut edge may hold one particle
/// alone, a quarter of a cell from its nodes: omega^2 = 3 K / (rho h^2) (1/xi + 1/(1 - xi)) = 9.9 c_d^2 / h^2 at xi =
/// 1/4 and nu = 0.3, so dt < 2 / omega = 0.635 h / c_d; a full cell allows 0.734 (methods.md A.6). Seen: 0.7 is
/// unstable there.
inline constexpr Real deformed_step_share = 0.63;

/// dt = min( cfl h_f / c_d,  deformed_step_share h_l / (c_d s + |v|) ).
///
/// s is the largest compression of a cell of the level: total formulation max |F^{-T} e_a| over axes and particles that
/// still transmit force (damage < 1), and |v| = 0; updated formulation s = 1 and |v| the largest particle speed.
/// @return  ms
/// @error   core::NumericalError if a velocity or deformation is not finite, naming the particle
Real stable_time_step(const Problem& problem, const Prepared& prepared, const State& state);
} // namespace solver
