/// What [grid] of a case says of cells and particles, in the words of the folders below.
#pragma once

#include "solver/problem.h"

#include <cmath>

namespace solver
{
inline refine::Lattice lattice_of(const Grid& grid)
{
    return {grid.cell, grid.origin, grid.levels};
}

/// Particles of a cell along an axis; the nearest number if particles_per_cell is no cube.
inline int particles_per_axis(const Grid& grid)
{
    return static_cast<int>(std::lround(std::cbrt(grid.particles_per_cell)));
}
} // namespace solver
