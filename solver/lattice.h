/// What [grid] of a case says of cells and particles, in the words of the folders below.
#pragma once

#include "refine/coverage.h"
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

/// What is asked of the mesh to come.
/// @pre  the number of particles per cell is a cube
inline refine::Scene scene_of(const Problem& problem)
{
    refine::Scene scene{
        lattice_of(problem.grid), problem.zones, {}, problem.grid.edge, particles_per_axis(problem.grid)};
    for (const Body& body : problem.bodies) scene.bodies.push_back(body.shape);
    return scene;
}
} // namespace solver
