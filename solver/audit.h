/// Energies of the present state.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
/// Kinetic energy sum m v^2 / 2 of the particles (the affine part of APIC counts as residual), in the nodal scheme of
/// the nodes, stored elastic energy sum V sigma : C^{-1} : sigma / 2, dissipation so far, work of the loads and of
/// gravity.
/// @return  mJ, of the modelled part; sums in leaf order
Ledger audit(const Prepared& prepared, const State& state);

/// Momentum of all particles [g mm/ms], for tests and reports.
Vec3 momentum(const particles::Particles& particles);
} // namespace solver
