/// Exchange between the tiles of one level: whoever owns a node gathers it, in a fixed order of neighbours.
///
/// No atomics and no colours: pass one adds the seven lower neighbours' halo entries to the owner, pass two copies the
/// owner's result into the halos of its own tile from the seven upper neighbours. Same bits for any thread count.
#pragma once

#include "grid/levels.h"

namespace grid
{
/// Own mass, momentum and force += halo entries of the seven lower neighbours.
void assemble_sums(Levels& levels);

/// The same for momentum alone (second mapping of MUSL).
void assemble_momentum(Levels& levels);

/// Halo velocities and changes = what the seven upper neighbours own; from a level on.
void fill_motion_halos(Levels& levels, int first_level = 0);
} // namespace grid
