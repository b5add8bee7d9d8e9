// Damping, of all motion and of what is faster than its mean: what it takes, what it leaves alone, that the ledger has
// it.
#include "solver/damping.h"

#include "solver/audit.h"
#include "tests/solver/free_bar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

using support::Job;

namespace
{
constexpr Real no_memory = std::numeric_limits<Real>::infinity();

/// The free bar in cells of `cell`, damped.
solver::Problem damped_bar(const solver::Numerics& numerics, Real cell, Real damping, Real memory)
{
    solver::Problem problem = test::free_bar(cell);
    problem.numerics = numerics;
    problem.numerics.damping = damping;
    problem.numerics.damping_memory = memory;
    return problem;
}

const solver::Numerics nodal_schemes[] = {support::nodal_numerics(solver::Precision::f64),
                                          support::nodal_numerics(solver::Precision::mixed)};
} // namespace

TEST(Damping, slows_a_free_body_exponentially_and_is_in_the_ledger)
{
    for (const solver::Numerics& numerics : test::schemes) {
        solver::Problem problem = damped_bar(numerics, 0.5, 30, no_memory);
        problem.bodies[0].velocity = Vec3(1, 2, 0);
        Job run = support::started(problem);
        const solver::Ledger start = solver::audit(run.prepared, run.state);
        support::advance(100, run);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        const Real kept = std::exp(-2 * 30 * run.state.clock.time);
        EXPECT_NEAR(ledger.kinetic / (start.kinetic * kept), 1, 1e-4);
        EXPECT_NEAR(ledger.residual() / start.kinetic, 0, 1e-4);
    }
}

TEST(Damping, with_a_memory_leaves_steady_motion_alone)
{
    for (const solver::Numerics& numerics : nodal_schemes) {
        solver::Problem problem = damped_bar(numerics, 0.5, 300, 0.01);
        test::add_fine_corner(problem);
        problem.bodies[0].velocity = Vec3(1, 2, 0);
        Job run = support::started(problem);
        const solver::Ledger start = solver::audit(run.prepared, run.state);
        support::advance(100, run);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        EXPECT_NEAR(ledger.kinetic / start.kinetic, 1, 1e-6);
        EXPECT_NEAR(ledger.damping / start.kinetic, 0, 1e-6);
    }
}

// v' = -a (v - u), u' = (v - u) / T from u = 0: v tends to v0 / (1 + a T), as if the body had to pull a T of its mass.
TEST(Damping, with_a_memory_ends_when_the_mean_has_come_to_the_velocity)
{
    const Real a = 50, memory = 0.01, speed = 2;
    for (const solver::Numerics& numerics : nodal_schemes) {
        Job run = support::started(damped_bar(numerics, 0.5, a, memory));
        for (std::size_t n = 0; n < run.state.levels.motion.size(); ++n)
            run.state.levels.motion[n].velocity = {0, speed, 0};
        support::advance(600, run);
        ASSERT_GT(run.state.clock.time, 10 * memory);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        const Real mass = 8e-3, last = speed / (1 + a * memory);
        EXPECT_NEAR(ledger.kinetic / (mass * last * last / 2), 1, 1e-4);
        EXPECT_NEAR(ledger.damping / (mass * (speed * speed - last * last) / 2), 1, 1e-4);
    }
}

TEST(Damping, with_a_memory_takes_waves)
{
    const Real a = 20, memory = 0.004;
    for (const solver::Numerics& numerics : nodal_schemes) {
        solver::Problem problem = damped_bar(numerics, 0.125, a, memory);
        problem.materials[0].elastic.poisson_ratio = 0;
        problem.motions = {{"wave", problem.materials[0].elastic,
                            solver::StandingWave{1, 1, solver::WaveKind::bar, 8, 0, std::numbers::pi / 2, 1e-2}}};
        problem.bodies[0].initial = 0;
        Job run = support::started(problem);
        const solver::Ledger start = solver::audit(run.prepared, run.state);
        const Real omega = 2 * std::numbers::pi * 1000 / 8; // rad/ms, waves run at 1000 mm/ms
        const Real share = omega * memory * omega * memory;
        while (run.state.clock.time < 5 * 2 * std::numbers::pi / omega) support::advance(1, run);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        const Real kept = std::exp(-a * run.state.clock.time * share / (1 + share));
        EXPECT_LT(kept, 0.5);
        EXPECT_NEAR((ledger.kinetic + ledger.elastic) / start.kinetic / kept, 1, 0.03);
        EXPECT_NEAR(ledger.residual() / start.kinetic, 0, 0.01);
    }
}

TEST(Damping, with_a_memory_goes_on_with_the_same_bits_after_a_restart)
{
    for (const solver::Numerics& numerics : nodal_schemes) {
        solver::Problem problem = support::bar(support::metal(), 5, 0.001);
        problem.numerics = numerics;
        problem.numerics.damping = 50;
        problem.numerics.damping_memory = 0.01;
        test::add_fine_corner(problem);
        Job run = support::started(problem);
        support::advance(50, run);
        test::expect_same_bits_after_a_restart(40, run);
    }
}

// Pulled on one face, held on the other, damped to rest: the load that holds it bears what the face does, and damping
// takes no work any more, on nodes at a level interface neither.
TEST(Damping, neither_bears_a_body_at_rest_nor_takes_work_from_it)
{
    for (const solver::Numerics& scheme : test::schemes)
        for (const Real memory : {no_memory, 0.02}) {
            if (memory < no_memory && scheme.transfer != solver::Transfer::nodal) continue;
            solver::Problem problem = support::bar(support::metal(), 0, 0);
            problem.loads.erase(problem.loads.begin());
            problem.force_upper = problem.force_lower = "bottom";
            problem.numerics = scheme;
            problem.numerics.damping = 600; // near the critical one: 300 rad/ms along the bar
            problem.numerics.damping_memory = memory;
            test::add_fine_corner(problem);
            problem.surface_loads = {
                test::surface_load(solver::SurfaceLoad::Kind::traction, support::beyond(1, 3.6, 1), 0, {0, 0.1, 0})};
            problem.surface_loads[0].facing = Vec3(0, 1, 0);
            Job run = support::started(problem);
            support::advance(1200, run);
            const solver::Ledger before = solver::audit(run.prepared, run.state);
            const Real time = run.state.clock.time;
            for (solver::LoadState& load : run.state.loads) load.impulse = Vec3::Zero();
            support::advance(1200, run);
            const Real tolerance = scheme.precision == solver::Precision::mixed ? 1e-3 : 1e-4;
            EXPECT_NEAR(run.state.loads[0].impulse[1] / (-0.2 * (run.state.clock.time - time)), 1, 10 * tolerance);
            // Boxes reach nodes whose forces cancel in every particle: these nodes are damped for ever.
            if (scheme.basis == solver::Basis::gimp) continue;
            const solver::Ledger ledger = solver::audit(run.prepared, run.state);
            EXPECT_LT(std::abs(ledger.damping - before.damping), tolerance * ledger.external);
        }
}

// What a load gives is force times way, whatever damping would do to the nodes it moves: the ledger closes as without.
TEST(Damping, of_nodes_that_a_load_moves_is_not_in_the_ledger)
{
    for (const solver::Numerics& numerics : test::schemes) {
        const auto pulled = [&](Real damping) {
            solver::Problem problem = support::bar(support::metal(), 0.1, 0.05);
            problem.numerics = numerics;
            problem.numerics.damping = damping;
            if (numerics.transfer == solver::Transfer::nodal) problem.numerics.damping_memory = 0.02;
            test::add_fine_corner(problem);
            Job run = support::started(problem);
            support::advance(300, run);
            return solver::audit(run.prepared, run.state);
        };
        const solver::Ledger free = pulled(0), damped = pulled(200);
        EXPECT_GT(damped.damping, 0.03 * damped.external);
        EXPECT_NEAR(damped.residual() / damped.external, free.residual() / free.external, 1e-3);
    }
}
