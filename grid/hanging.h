/// Cells whose corners hang between masters, and the affine momentum their particles send on to the masters (APIC).
///
/// P carries a slave's momentum to its masters as if the masters were at the slave's place. A particle with an affine
/// velocity field means something else for each master; the difference is, with the masters' positions x_a,
///
///     p_a += sum_i P_ia T_i (x_a - x_i),     T_i = sum_p m_p w_i C_p
///
/// (methods.md A.3.5). Angular momentum is then exact about the masters, and an affine velocity field stays affine.
/// The way back is transfer/hanging_cell.h. Nothing happens at slaves that sit on their master (x_a = x_i).
#pragma once

#include "grid/levels.h"

namespace grid
{
/// Find the active cells of `level` with a hanging corner, and the cells around each slave.
/// @param face  reads the rows of P of the interface below `level`; writes hanging, without room for affine matrices
void find_hanging_cells(const Levels& levels, int level, LevelInterface& face);

/// Room for the affine matrices of every hanging cell; from now on the restrictions pass them on.
void keep_affine(Levels& levels);

/// The sum above for interface number `face`; nothing if there is no room for affine matrices.
/// @param levels  reads hanging.affine; writes hanging.slave_affine and the momentum of masters
void restrict_affine(std::size_t face, Levels& levels);
} // namespace grid
