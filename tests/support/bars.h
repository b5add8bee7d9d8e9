/// Bars one coarse cell thick with Poisson ratio 0: one-dimensional problems in the three-dimensional code.
#pragma once

#include "tests/support/runs.h"

namespace support
{
/// Bar [0, length] x [0, h] x [0, h] with h = length / cells; E = stiffness, cells beyond `fine_from` are halved.
inline solver::Problem thin_bar(Real length, int cells, Real stiffness, Real density,
                                std::optional<Real> fine_from = {})
{
    solver::Problem problem;
    problem.title = "thin bar";
    problem.grid.cell = length / cells;
    material::Material m;
    m.elastic = {density, stiffness, 0};
    problem.materials = {m};
    problem.bodies = {{"bar", geometry::box({0, 0, 0}, {length, problem.grid.cell, problem.grid.cell}), 0, {0, 0, 0}}};
    problem.end.separated = false;
    if (fine_from) {
        problem.grid.levels = 2;
        // A little inside, so that the cells on the other side of the interface are not touched.
        problem.zones = {zone(beyond(0, *fine_from + 1e-3 * problem.grid.cell, 1), 1)};
    }
    return problem;
}

/// Set v_x(X), its slope (for affine particles) and sigma_xx(X), and begin with them.
template <class Velocity, class Slope, class Stress>
void set_wave(const Velocity& velocity, const Slope& slope, const Stress& stress, Job& run)
{
    restart_with(
        [&](particles::Particles& particles) {
            for (std::size_t p = 0; p < particles.size(); ++p) {
                const Real x = particles.rest_position[0][p];
                particles.velocity[0][p] = velocity(x);
                particles.stress[0][p] = stress(x);
                if (!particles.affine[0].empty()) particles.affine[0][p] = slope(x);
            }
        },
        run);
}
} // namespace support
