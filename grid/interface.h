/// Constrained nodes where a level meets a coarser one: P, and restriction as exactly P^T (methods.md A.3.2).
#pragma once

#include "grid/levels.h"

namespace grid
{
/// Find the slave nodes of every level and the rows of P.
///
/// A node of level l >= 1 is a slave if among the eight level-l cells around it one is active and one has its parent in
/// C_{l-1}.
/// Its masters are the tensor product over the axes of {i/2: 1} for an even, {(i-1)/2: 1/2, (i+1)/2: 1/2} for an odd
/// index. All masters are corners of the coarse leaf cell the node touches.
///
/// @param levels  reads leaves, cell_active; writes constrained, interface
/// @pre   strong 2:1 balance
void build_interfaces(Levels& levels);

/// Add mass, momentum and force of slaves to their masters, finest level first, and clear the slaves: P^T. With APIC
/// the masters also get what the affine matrices add between slave and master (grid/hanging.h).
/// @pre  the halos of every level are assembled
void restrict_sums(Levels& levels);

/// The same for momentum alone (second mapping of MUSL).
void restrict_momentum(Levels& levels);

/// Velocity and velocity change of slaves from their masters, coarsest level first: P.
void prolong_motion(Levels& levels);

/// Nodal scheme: displacement of the slaves on the levels of `steps` from their masters, and as velocity the mean over
/// the step of their level, which just ends: masters may have changed theirs within it.
void prolong_displacement(const LevelSteps& steps, Levels& levels);
} // namespace grid
