/// The momentum update on the nodes, symplectic Euler, with symmetry planes.
///
/// v = p / m,  v+ = v + dt (f / m + g);  normal components on symmetry planes are zero before and
/// after.
#pragma once

#include "grid/walls.h"

namespace grid
{
/// @param gravity      mm/ms^2
/// @param mass_cutoff  g, per level: lighter nodes do not move
/// @param dt           ms
/// @param levels       reads assembled and restricted sums; writes motion of owned nodes; slaves get zeros
void advance_momentum(const std::vector<WallPlane>& walls, const Vec3& gravity, const std::vector<Real>& mass_cutoff,
                      Real dt, Levels& levels);

/// Replace `change` by the velocity p / m of momentum mapped again from updated particles (MUSL), walls applied.
void remap_velocity(const std::vector<WallPlane>& walls, const std::vector<Real>& mass_cutoff, Levels& levels);
} // namespace grid
