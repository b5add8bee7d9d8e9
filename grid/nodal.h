/// The nodal scheme on the grid: the nodes keep mass, velocity and (in `change`) displacement; only forces are mapped.
#pragma once

#include "grid/walls.h"

namespace grid
{
/// Take mass and velocity p / m from the sums, displacement 0, walls applied; halos and slaves of the motion are not
/// yet filled. `force` gets what the particles have scattered, as the first step expects it, and `sum` is emptied.
///
/// Nodes below the mass cutoff never move.
/// @pre  sums as scattered, halos not assembled
void start_nodes(const std::vector<WallPlane>& walls, const std::vector<Real>& mass_cutoff, Levels& levels);

/// Only the mass, into a `force` that holds forces already; `sum` is emptied.
/// @pre  sums as scattered, halos not assembled
void restore_masses(const std::vector<Real>& mass_cutoff, Levels& levels);

/// Assemble forces over leaves and levels, v+ = v + dt (f / m + g), u += dt v+, walls applied; every level of `steps`
/// by its own dt. Where these are equal, `force` of every owned node that moves is the whole f then.
///
/// One walk over the tiles: a leaf adds the halo forces of its lower neighbours and moves its nodes at once; what
/// slaves then give to their masters is a second, smaller push.
void advance_nodes(const std::vector<WallPlane>& walls, const Vec3& gravity, const LevelSteps& steps, Levels& levels);
} // namespace grid
