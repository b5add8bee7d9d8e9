// Runs that must agree to the last bit (methods.md A.4, 15 and 16): however many levels carry the same cells, however
// many threads work, and across a restart. The scene yields, turns,
// is reordered and breaks.
#include "tests/solver/same_bits.h"

#include "solver/audit.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

using support::Job;

namespace
{
material::Material breakable()
{
    material::Material m = support::metal();
    m.plastic = material::VonMises{10, 100};
    m.decohesion = material::Decohesion{};
    m.decohesion->s_max = 11;
    m.decohesion->tau_max = 50;
    m.decohesion->u0 = 2e-3;
    return m;
}

/// A bar with a hole, on cells of 0.25 mm, that will spin about a pin and stretch until it breaks.
solver::Problem torn_bar(solver::Formulation formulation)
{
    const solver::Load pin = support::pin("pin", {1, 4, 0}, 0.4, {0.0, 0.0, {}}, 0);
    solver::Problem problem = support::bar(breakable(), 0, 0);
    problem.bodies[0].shape = geometry::subtract(geometry::box({0, 0, 0}, {2, 8, 1}), {pin.region});
    problem.loads = {pin};
    problem.grid.cell = 0.25;
    problem.numerics = support::numerics(formulation);
    return problem;
}

/// Two levels: fine around the hole.
solver::Problem refined_torn_bar(solver::Formulation formulation)
{
    solver::Problem problem = torn_bar(formulation);
    problem.grid.cell = 0.5;
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({0.2, 3, -1}, {3, 5, 2}), 1)};
    return problem;
}

/// Turning at 12 rad/ms, stretching at 8 per ms.
Job torn(const solver::Problem& problem)
{
    Job run = support::started(problem);
    particles::Particles& particles = run.state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Real x = particles.position[0][p] - 1, y = particles.position[1][p] - 4;
        particles.velocity[0][p] = -12 * y;
        particles.velocity[1][p] = 12 * x + 8 * y;
    }
    run.state.loads[0].spin = 12;
    transfer::scatter(run.prepared.options, run.prepared.laws, run.state.strays, particles, run.state.levels);
    return run;
}

constexpr solver::Formulation formulations[] = {solver::Formulation::updated, solver::Formulation::total};

Job run_on(int threads, const solver::Problem& problem, int steps)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute([&] {
        Job run = torn(problem);
        support::advance(steps, run);
        return run;
    });
}
} // namespace

TEST(SameBits, the_scene_has_cracks_strays_and_reorderings)
{
    Job run = torn(refined_torn_bar(solver::Formulation::updated));
    std::size_t most_strays = 0;
    int reorderings = 0;
    for (int n = 0; n < 200; ++n) {
        const std::vector<std::uint32_t> before = run.state.particles.id;
        support::advance(1, run);
        most_strays = std::max(most_strays, run.state.strays.size());
        reorderings += run.state.particles.id != before ? 1 : 0;
    }
    EXPECT_GT(run.state.particles.cracks.size(), 20U);
    EXPECT_GT(most_strays, 10U);
    EXPECT_GT(reorderings, 2);
    const auto& v = run.state.particles.velocity[1];
    EXPECT_LT(*std::max_element(v.begin(), v.end()), 200); // broken, not blown up
}

TEST(SameBits, for_any_number_of_levels_that_carry_the_same_cells)
{
    for (const solver::Formulation formulation : formulations) {
        Job single = torn(torn_bar(formulation));
        const std::vector<std::uint32_t> first_id = single.state.particles.id;
        const particles::Column first_rest_x = single.state.particles.rest_position[0];
        support::advance(120, single);
        EXPECT_GT(single.state.particles.cracks.size(), 0U);
        for (const int levels : {2, 3}) {
            solver::Problem problem = torn_bar(formulation);
            problem.grid.cell *= 1 << (levels - 1);
            problem.grid.levels = levels;
            problem.zones = {support::zone(support::everywhere(), levels - 1)};
            Job nested = torn(problem);
            // Seeding numbers the particles parent cell by parent cell; the order inside a cell is by number.
            ASSERT_TRUE(test::same_bits(nested.state.particles.rest_position[0], first_rest_x));
            nested.state.particles.id = first_id;
            support::advance(120, nested);
            EXPECT_EQ(single.state.clock.time, nested.state.clock.time);
            test::expect_same_particles(single.state.particles, nested.state.particles);
            test::expect_same_loads(single.state.loads, nested.state.loads);
        }
    }
}

TEST(SameBits, for_any_number_of_threads)
{
    for (const solver::Formulation formulation : formulations) {
        const solver::Problem problem = refined_torn_bar(formulation);
        const Job one = run_on(1, problem, 200);
        EXPECT_GT(one.state.particles.cracks.size(), 0U);
        for (const int threads : {2, 4}) {
            const Job many = run_on(threads, problem, 200);
            test::expect_same_particles(one.state.particles, many.state.particles);
            test::expect_same_loads(one.state.loads, many.state.loads);
            EXPECT_EQ(one.state.particles.id, many.state.particles.id);
            EXPECT_EQ(solver::audit(one.prepared, one.state).residual(),
                      solver::audit(many.prepared, many.state).residual());
        }
    }
}

// What a checkpoint holds is enough: particles in stored order, leaves with their active cells, loads and clock.
TEST(SameBits, after_a_restart_at_any_step)
{
    for (const solver::Formulation formulation : formulations) {
        Job run = torn(refined_torn_bar(formulation));
        for (int n = 0; n < 20; ++n) {
            support::advance(7, run);
            Job restarted{run.problem, run.prepared, {}, run.state};
            restarted.state.levels.topology = nullptr;
            restarted.state.levels.sum.clear();
            restarted.state.levels.motion.clear();
            restarted.state.levels.interface.clear();
            restarted.state.strays = {};
            solver::resume(restarted.problem, restarted.prepared, restarted.state, restarted.derived);
            Job straight = run;
            support::advance(2, straight);
            support::advance(2, restarted);
            test::expect_same_particles(straight.state.particles, restarted.state.particles);
            test::expect_same_loads(straight.state.loads, restarted.state.loads);
            ASSERT_FALSE(HasFailure()) << "after step " << run.state.clock.step;
        }
        EXPECT_GT(run.state.particles.cracks.size(), 0U);
    }
}

// The sums a step starts from are those `scatter` finds, also in the step in which a crack begins.
TEST(SameBits, sums_after_a_step_are_those_of_a_fresh_scatter)
{
    for (const solver::Formulation formulation : formulations) {
        Job run = torn(refined_torn_bar(formulation));
        for (int n = 0; n < 150; ++n) {
            support::advance(1, run);
            grid::Levels again = run.state.levels;
            transfer::scatter(run.prepared.options, run.prepared.laws, run.state.strays, run.state.particles, again);
            ASSERT_TRUE(test::same_bits(again.sum, run.state.levels.sum)) << "step " << n;
        }
        EXPECT_GT(run.state.particles.cracks.size(), 0U);
    }
}
