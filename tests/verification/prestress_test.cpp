// A stretched block held at both ends is in equilibrium whatever its cells (methods.md B17): free hanging nodes or a
// one-sided interface would set it in motion at once.
#include "solver/audit.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

namespace
{
/// Kinetic over elastic energy after 500 steps.
Real motion_of(const solver::Numerics& numerics, int levels, const geometry::Shape& refined)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.bodies[0].shape = geometry::box({0, 0, 0}, {4, 6, 4});
    problem.loads[0].region = support::beyond(1, 6, 1);
    problem.grid.cell = 1;
    problem.grid.levels = levels;
    problem.zones = {support::zone(refined, levels - 1)};
    problem.numerics = numerics;
    support::Job run = support::started(problem);
    support::restart_with([](particles::Particles& particles) { particles.stress[1].assign(particles.size(), 7); },
                          run);
    support::advance(500, run);
    const solver::Ledger ledger = solver::audit(run.prepared, run.state);
    return ledger.kinetic / ledger.elastic;
}
} // namespace

TEST(Prestress, a_block_of_several_levels_stays_at_rest)
{
    const Vec3 lower(0.9, 1.9, -1), upper(2.1, 3.1, 2.1);
    const geometry::Shape corner = geometry::box(lower, upper);
    const geometry::Shape wrapped =
        geometry::unite({geometry::box({-1, -1, -1}, {1.9, 7, 5}), geometry::box({-1, -1, -1}, {5, 2.9, 5}),
                         geometry::box({-1, -1, -1}, {5, 7, 1.9})});
    using enum solver::Formulation;
    const auto usl = [](solver::Formulation formulation) {
        solver::Numerics numerics;
        numerics.formulation = formulation;
        return numerics;
    };
    for (const solver::Numerics& numerics : {usl(updated), usl(total), support::nodal_numerics(solver::Precision::f64),
                                             support::nodal_numerics(solver::Precision::mixed)})
    {
        // Forces of cells cancel at the nodes to the rounding of the particles' numbers, squared here.
        const Real rest = numerics.precision == solver::Precision::mixed ? 1e-12 : 1e-20;
        EXPECT_LT(motion_of(numerics, 2, corner), rest);
        EXPECT_LT(motion_of(numerics, 2, wrapped), rest);
        EXPECT_LT(motion_of(numerics, 3, corner), rest);
    }
}
