#include "solver/prepared.h"

#include "core/error.h"
#include "solver/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace solver
{
namespace
{
grid::WallPlane wall_of(const SymmetryPlane& plane, const Grid& lattice)
{
    const Real index = (plane.at - lattice.origin[plane.axis]) / lattice.cell;
    const Real nearest = std::round(index);
    if (std::abs(index - nearest) > 1e-9)
        throw core::InputError(fmt::format("symmetry plane {} = {} mm lies between node planes of level 0 (nearest: {} "
                                           "mm); move it or set grid.origin",
                                           "xyz"[plane.axis], plane.at,
                                           lattice.origin[plane.axis] + nearest * lattice.cell));
    return {plane.axis, static_cast<int>(nearest)};
}
} // namespace

Prepared prepare(const Problem& problem)
{
    Prepared prepared;
    prepared.laws = transfer::law_table(problem.materials);
    prepared.gravity = problem.gravity;
    prepared.options.formulation = problem.numerics.formulation;
    prepared.options.transfer = problem.numerics.transfer;
    prepared.options.stress_update = problem.numerics.stress_update;
    prepared.options.precision = problem.numerics.precision;
    prepared.options.pic_fraction = problem.numerics.pic_fraction;
    prepared.options.basis = problem.numerics.basis;
    for (const SymmetryPlane& plane : problem.symmetry) prepared.walls.push_back(wall_of(plane, problem.grid));
    Real density = 0;
    for (const material::Material& m : problem.materials) {
        density = std::max(density, m.elastic.density);
        prepared.wave_speed = std::max(prepared.wave_speed, m.elastic.wave_speed());
    }
    for (int l = 0; l < problem.grid.levels; ++l) {
        const Real spacing = problem.grid.cell / static_cast<Real>(1 << l);
        prepared.mass_cutoff.push_back(problem.numerics.mass_cutoff * density * spacing * spacing * spacing);
    }
    prepared.per_axis = particles_per_axis(problem.grid);
    if (prepared.per_axis * prepared.per_axis * prepared.per_axis != problem.grid.particles_per_cell)
        throw core::InputError(
            fmt::format("grid.particles_per_cell = {} is not a cube number", problem.grid.particles_per_cell));
    prepared.options.per_axis = prepared.per_axis;
    prepared.options.walls = prepared.walls;
    return prepared;
}
} // namespace solver
