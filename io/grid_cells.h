/// The cells of the nested grid that hold material, level by level, with the coarser cells that finer ones fill.
///
/// A cell holds the particles whose home it is. A coarser cell is filled if all eight cells below it are listed; it is
/// listed too and holds the same material. At a surface of the body, where some of the eight are empty, the finer cells
/// stand alone.
#pragma once

#include "core/real.h"
#include "grid/levels.h"

#include <cstdint>
#include <span>
#include <vector>

namespace io
{
/// Cells of one level, sorted by x, then y, then z.
struct GridCells
{
    std::vector<Index3> place;           // [c] node index of the lower corner on its level
    std::vector<std::uint8_t> covered;   // [c] 1: filled by the next finer level
    std::vector<std::uint32_t> particle; // [c] first particle at home in it
    std::vector<std::uint32_t> count;    // [c] 1, particles at home in it
    std::vector<std::int64_t> parent; // [c] the filled cell of the next coarser level it lies in, or -1; level 0: empty
};

/// Cells of every level up to the finest that holds a particle; at least level 0.
/// @pre no particle is at home in a cell that has particles on a finer level
/// @cost  n log n in the number of cells
std::vector<GridCells> grid_cells(const grid::Levels& levels);

/// Sums of weight x value over the particles in every cell, those in finer cells below it included.
///
/// @param values  [p][components]; empty: 1
/// @param weight  [p]
/// @return [level][c][components]
/// @pre the particles are in the order of levels.cell_start
std::vector<std::vector<Real>> sum_over_cells(const std::vector<GridCells>& cells, std::span<const Real> weight,
                                              std::span<const Real> values = {}, int components = 1);
} // namespace io
