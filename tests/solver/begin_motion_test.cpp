// Bodies that begin with a motion: what the first step, the ledger, the gauge and the measures find at time 0.
#include "solver/begin_motion.h"

#include "solver/audit.h"
#include "solver/observe.h"
#include "solver/sample.h"
#include "tests/solver/free_bar.h"
#include "tests/support/topologies.h"

#include <gtest/gtest.h>

using support::Job;

namespace
{
constexpr Real amplitude = 0.01; // mm

/// The free bar where a wave turns round: u_k = A sin(pi X_k / 8) sin(pi (1/2 + c t / 8)).
solver::Problem displaced_bar(const solver::Numerics& numerics)
{
    solver::Problem problem = test::free_bar(0.5);
    problem.numerics = numerics;
    problem.motions = {
        {"wave", problem.materials[0].elastic, solver::BoxWave{Vec3::Zero(), 8, amplitude, 1, Vec3::Constant(0.5)}}};
    problem.bodies[0].initial = 0;
    return problem;
}

solver::Problem displaced_bar_of_two_levels()
{
    solver::Problem problem = displaced_bar(support::subcycled_numerics(solver::Precision::f64));
    test::add_fine_corner(problem);
    return problem;
}

Vec3 vector_of(const std::array<Real, 3>& v)
{
    return {v[0], v[1], v[2]};
}
} // namespace

// What drifts within a step of its level begins where its node is, not at rest.
TEST(BeginMotion, with_subcycling_nodes_of_the_interface_begin_displaced)
{
    const Job run = support::started(displaced_bar_of_two_levels());
    const std::vector<grid::FastNode>& coarse = run.derived.fast_nodes.at(0);
    ASSERT_GT(coarse.size(), 10U);
    for (const grid::FastNode& node : coarse) {
        const Vec3 u = at(run.problem.motions[0], support::position_of(run.state.levels, node.at), 0).displacement;
        EXPECT_GT(u.norm(), 0.1 * amplitude);
        EXPECT_LT((vector_of(node.begin) - u).norm(), 1e-12 * amplitude);
        EXPECT_LT((vector_of(node.now) - u).norm(), 1e-12 * amplitude);
    }
}

TEST(BeginMotion, with_subcycling_each_level_is_set_back_by_half_of_its_own_step)
{
    const Job run = support::started(displaced_bar_of_two_levels());
    const grid::Levels& levels = run.state.levels;
    std::array<int, 2> checked{};
    support::for_each_free_node(levels, [&](const grid::NodeAddress& node, const Vec3& x) {
        const auto leaf = static_cast<std::size_t>(node.leaf);
        if (levels.forces(leaf)[node.node].per_mass == 0) return;
        const int level = levels.leaves[leaf].level;
        const Real step = run.state.clock.dt / (1 << level); // the clock has that of the coarsest level
        const Vec3 wanted = at(run.problem.motions[0], x, -step / 2).velocity;
        const Vec3 doubled = at(run.problem.motions[0], x, -step).velocity;
        if ((doubled - wanted).norm() < 1e-3) return; // near the corner that stays
        EXPECT_LT((vector_of(levels.motions(leaf)[node.node].velocity) - wanted).norm(), 1e-9) << x.transpose();
        ++checked[static_cast<std::size_t>(level)];
    });
    EXPECT_GT(checked[0], 50);
    EXPECT_GT(checked[1], 50);
}

// Velocities are those of half a step earlier, and measured as such from the first sample on.
TEST(BeginMotion, velocities_at_time_0_have_no_error)
{
    for (const solver::Numerics& numerics :
         {support::numerics(solver::Formulation::total), support::numerics(solver::Formulation::updated),
          support::nodal_numerics(solver::Precision::f64), support::subcycled_numerics(solver::Precision::f64)})
    {
        solver::Problem problem = test::free_bar(0.5);
        problem.numerics = numerics;
        test::add_fine_corner(problem);
        // Linear in space, so that what nodes interpolate is exact as well.
        problem.motions = {{"spin", problem.materials[0].elastic, solver::Spin{{1, 2, 0.5}, 2, 20, {1, 2, 3}}}};
        problem.bodies[0].initial = 0;
        // Not beside the interface, where slaves have the half step of their masters.
        const solver::FieldError error{
            solver::FieldComponent::Field::velocity, 0, solver::FieldError::Norm::max,
            geometry::unite({geometry::box({-1, -1, -1}, {1.2, 1.7, 2}), support::beyond(1, 2.1, 1)})};
        problem.quantities = {{"error", error, {}, 1, {}, {}}};
        Job run = support::started(problem);
        EXPECT_LT(take_sample(run.problem, run.prepared, run.derived, run.state).value[0], 1e-9);
    }
}

TEST(BeginMotion, a_displacement_at_time_0_is_neither_work_of_gravity_nor_an_opening)
{
    for (const solver::Numerics& numerics : test::schemes) {
        solver::Problem problem = displaced_bar(numerics);
        problem.gravity = Vec3(0, -1e4, 0);
        problem.gauge = solver::Gauge{{1, 3, 0.5}, {1, 1, 0.5}, 1};
        Job run = support::started(problem);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        EXPECT_LT(ledger.external, -0.1 * 8e-3 * 1e4 * amplitude);
        // But for the kinetic energy half a step earlier.
        EXPECT_LT(std::abs(ledger.residual()), 1e-3 * std::abs(ledger.external));
        EXPECT_GT(std::abs(run.state.gauge_start), 0.1 * amplitude);
        EXPECT_NEAR(solver::gauge_opening(run.problem, run.state, run.derived), 0, 1e-14);
    }
}
