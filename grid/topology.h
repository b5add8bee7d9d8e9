/// Build the leaves, tiles and level interfaces for a set of occupied leaf cells.
#pragma once

#include "grid/levels.h"
#include "grid/refinement.h"

#include <vector>

namespace grid
{
/// Make `levels` hold exactly the leaves whose nodes the occupied cells touch.
///
/// @param occupied  leaf cells of the hierarchy that hold particles, any order, repeats allowed
/// @param levels    reads spacing0, count, origin; writes leaves, level_start, cell_active, used, topology, sum,
///                  motion, constrained, interface. cell_start is left empty: only who orders the particles knows it.
/// @cost  serial in the number of cells; called when the topology changes, never per step
void build(const std::vector<CellKey>& occupied, Levels& levels);

/// The same from stored leaves and active cells (leaf level and origin, level_start, cell_active): after a restart.
void restore(Levels& levels);

/// Subdivided cells implied by the active ones: every ancestor of an active cell.
Refinement refinement_of_cells(const Levels& levels);

/// Number of the leaf whose owned nodes (and cells) include `node` on `level`, or -1.
std::int32_t leaf_of(const Levels& levels, int level, const Index3& node);

/// leaf * 512 + cell of a cell, or -1 if there is no leaf around it.
std::int64_t slot_of(const Levels& levels, const CellKey& key);

/// The same of an active leaf cell, or -1 if the cell is not active.
std::int64_t active_slot(const Levels& levels, int level, const Index3& cell);

/// Make an empty leaf cell of the hierarchy active where that changes neither leaves nor interfaces: its eight nodes
/// exist and no active cell of another level touches it. Then everything but `cell_active` and `used` stays as it is.
/// @return leaf * 512 + cell, or -1 if only build() can do it
std::int64_t activate(const CellKey& key, Levels& levels);

/// Leaf cells of the hierarchy, in storage order.
std::vector<CellKey> active_cells(const Levels& levels);

/// Order by level, then by index: coarse cells first.
bool before(const CellKey& a, const CellKey& b);

/// Sort in that order and keep each cell once.
void sort_unique(std::vector<CellKey>& cells);
} // namespace grid
