/// What a Problem implies and every step needs, computed once.
#pragma once

#include "grid/momentum.h"
#include "solver/problem.h"
#include "transfer/law_table.h"
#include "transfer/passes.h"

#include <vector>

namespace solver
{
struct Prepared
{
    transfer::LawTable laws;
    transfer::PassOptions options; // dt and time are filled in by each step
    std::vector<grid::WallPlane> walls;
    std::vector<Real> mass_cutoff; // g, per level
    Vec3 gravity = Vec3::Zero();   // mm/ms^2
    Real wave_speed = 0;           // mm/ms, fastest c_d of all materials
    int per_axis = 2;              // particles per cell and axis
};

/// @error core::InputError if a symmetry plane is not a node plane of level 0 or particles_per_cell is not a cube
Prepared prepare(const Problem& problem);
} // namespace solver
