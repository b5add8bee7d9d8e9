/// Keep leaves, order and load nodes up with the particles (updated formulation; nothing moves in the total one).
#pragma once

#include "solver/step.h"

namespace solver
{
/// Regrid when strays cost more than an ordering or left the present cells; look load nodes up again when a region
/// moved.
void follow_particles(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// Cells for the particles, and particles for the cells: refine what is void beside finer cells, split.
void fit_cells(const Prepared& prepared, grid::Refinement& refinement, State& state);

/// Leaves in order, particles by cell; open the cells that boxes reach.
void order_cells(const Problem& problem, const Prepared& prepared, const grid::Refinement& refinement, State& state);

/// What follows from where particles and leaves are: strays, load nodes, gauges, columns of ligaments, surfaces.
/// @pre   derived.ligaments is the map of the problem
void find_places(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);

/// Refine where targets ask, split, order, rebuild; then sums and load nodes of the new order.
void regrid(const Problem& problem, const Prepared& prepared, State& state, Derived& derived);
} // namespace solver
