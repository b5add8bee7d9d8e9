/// The time step: a share `cfl` of the time a dilatational wave takes through the finest cell (methods.md A.6).
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
/// Steps between two estimates; the step is constant in between.
inline constexpr int time_step_interval = 32;

/// Largest cfl and share of the deformed width with sub-cycling: waves of the fine level resonate with the step of the
/// next coarser one from 0.72 on (methods.md A.7).
inline constexpr Real subcycled_step_share = 0.6;

/// A step below this share of that at rest ends the run: metal is squeezed to a millionth of its width somewhere, or
/// thrown away at a thousand times the speed of sound. Neither means anything, and the rest of the run would take
/// a thousand times as long. (The worst run of the challenge specimen came to a twenty-fifth.)
inline constexpr Real smallest_step_share = 1e-3;

/// Steps of the finest level in one of the coarsest.
inline int substeps(const Problem& problem)
{
    return problem.numerics.subcycling ? 1 << (problem.grid.levels - 1) : 1;
}

/// Step of the finest level, dt = min( cfl h_f / c_d,  transfer::deformed_step_share h_l / (c_d s + |v|) );  basis
/// gimp: box_step_share instead.
///
/// s tells how much faster waves pass the cells of the level than at rest: total formulation max |F^{-T} e_a|
/// sqrt(min(1, J)) over axes and particles that still transmit force (damage < 1), with motion on the nodes the largest
/// mean of a cell's corners (transfer/lattice_squeeze.h), and |v| = 0; updated formulation s = 1 and |v| the largest
/// particle speed.
/// With sub-cycling a level is held to its own step, 2^(l_max - l) dt, and the share is subcycled_step_share.
/// @return  ms
/// @error   core::NumericalError if a velocity or deformation is not finite, or the step is below smallest_step_share
/// of
///          cfl h_f / c_d, naming the particle
Real stable_time_step(const Problem& problem, const Prepared& prepared, const State& state);
} // namespace solver
