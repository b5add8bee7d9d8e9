/// The time step: a share `cfl` of the time a dilatational wave takes through the finest cell (methods.md A.6).
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
/// Steps between two estimates; the step is constant in between.
inline constexpr int time_step_interval = 32;

/// dt = min( cfl h_f / c_d,  transfer::deformed_step_share h_l / (c_d s + |v|) );  basis gimp: box_step_share instead.
///
/// s is the largest compression of a cell of the level: total formulation max |F^{-T} e_a| over axes and particles that
/// still transmit force (damage < 1), and |v| = 0; updated formulation s = 1 and |v| the largest particle speed.
/// @return  ms
/// @error   core::NumericalError if a velocity or deformation is not finite, naming the particle
Real stable_time_step(const Problem& problem, const Prepared& prepared, const State& state);
} // namespace solver
