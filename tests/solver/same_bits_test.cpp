// Runs that must agree to the last bit (methods.md A.4, 15 and 16): however many levels carry the same cells, however
// many threads work, and across a restart. The scene yields, turns,
// is reordered and breaks.
#include "tests/solver/same_bits.h"

#include "solver/audit.h"
#include "solver/stable_time_step.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

using support::Job;

namespace
{
/// A bar with a hole, on cells of 0.25 mm, that will spin about a pin and stretch until it breaks.
/// @param radius  mm, of the nonlocal onset
solver::Problem torn_bar(const solver::Numerics& numerics, Real radius = 0)
{
    const solver::Load pin = support::pin("pin", {1, 4, 0}, 0.4, {0.0, 0.0, {}}, 0);
    material::Material metal = support::breakable();
    metal.decohesion->nonlocal_radius = metal.decohesion->crack_exclusion = radius;
    if (radius > 0) { // shear fails with a strength that remembers
        metal.decohesion->tau_max = 5.2;
        metal.decohesion->tau_max_axial = 5.8;
        metal.decohesion->lode_memory = 0.01;
    }
    metal.decohesion->rotating_until = 0.5; // opening cracks first turn, then keep their planes
    metal.decohesion->renewed_plane = true;
    metal.decohesion->second_crack = true;
    solver::Problem problem = support::bar(metal, 0, 0);
    problem.bodies[0].shape = geometry::subtract(geometry::box({0, 0, 0}, {2, 8, 1}), {pin.region});
    problem.loads = {pin};
    problem.grid.cell = 0.25;
    problem.numerics = numerics;
    return problem;
}

/// Two levels: fine around the hole.
solver::Problem refined_torn_bar(const solver::Numerics& numerics, Real radius = 0)
{
    solver::Problem problem = torn_bar(numerics, radius);
    problem.grid.cell = 0.5;
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({0.2, 3, -1}, {3, 5, 2}), 1)};
    return problem;
}

/// Turning at 12 rad/ms, stretching at 8 per ms.
Job torn(const solver::Problem& problem)
{
    Job run = support::started(problem);
    support::restart_with(
        [](particles::Particles& particles) {
            for (std::size_t p = 0; p < particles.size(); ++p) {
                const Real x = particles.position[0][p] - 1, y = particles.position[1][p] - 4;
                particles.velocity[0][p] = -12 * y;
                particles.velocity[1][p] = 12 * x + 8 * y;
            }
        },
        run);
    run.state.loads[0].spin = 12;
    return run;
}

struct Scheme
{
    const char* name;
    solver::Numerics numerics;
    Real nonlocal_radius = 0; // mm
};

solver::Numerics musl(solver::Numerics numerics)
{
    numerics.stress_update = solver::StressUpdate::musl;
    return numerics;
}

const Scheme schemes[] = {
    {"updated", support::numerics(solver::Formulation::updated)},
    {"updated gimp", support::gimp_numerics(solver::Transfer::flip)},
    {"updated gimp musl", musl(support::gimp_numerics(solver::Transfer::flip))},
    {"updated gimp apic", support::gimp_numerics(solver::Transfer::apic)},
    {"total", support::numerics(solver::Formulation::total)},
    {"nodal", support::nodal_numerics(solver::Precision::f64)},
    {"nodal mixed", support::nodal_numerics(solver::Precision::mixed)},
    {"updated, nonlocal", support::numerics(solver::Formulation::updated), 0.4},
    {"updated gimp, nonlocal", support::gimp_numerics(solver::Transfer::flip), 0.4},
    {"total, nonlocal", support::numerics(solver::Formulation::total), 0.4},
    {"nodal, nonlocal", support::nodal_numerics(solver::Precision::f64), 0.4},
    {"nodal mixed, nonlocal", support::nodal_numerics(solver::Precision::mixed), 0.4},
    {"sub-cycled", support::subcycled_numerics(solver::Precision::f64)},
    {"sub-cycled mixed", support::subcycled_numerics(solver::Precision::mixed)},
};

/// Everything two runs have in common, in stored order.
void expect_same(Job& a, Job& b)
{
    test::expect_same_particles(support::particles_of(a), support::particles_of(b));
    test::expect_same_loads(a.state.loads, b.state.loads);
    if (!solver::nodal(a.problem)) return;
    EXPECT_TRUE(test::same_bits(a.state.levels.motion, b.state.levels.motion));
    EXPECT_TRUE(test::same_bits(a.state.levels.force, b.state.levels.force));
}

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
    Job run = torn(refined_torn_bar(support::numerics(solver::Formulation::updated)));
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
    for (const Scheme& scheme : schemes) {
        SCOPED_TRACE(scheme.name);
        Job single = torn(torn_bar(scheme.numerics, scheme.nonlocal_radius));
        const std::vector<std::uint32_t> first_id = single.state.particles.id;
        const particles::Column first_rest_x = single.state.particles.rest_position[0];
        support::advance(120, single);
        EXPECT_GT(single.state.particles.cracks.size(), 0U);
        for (const int levels : {2, 3}) {
            solver::Problem problem = torn_bar(scheme.numerics, scheme.nonlocal_radius);
            problem.grid.cell *= 1 << (levels - 1);
            problem.grid.levels = levels;
            problem.zones = {support::zone(support::everywhere(), levels - 1)};
            Job nested = torn(problem);
            // Seeding numbers the particles parent cell by parent cell; the order inside a cell is by number.
            ASSERT_TRUE(test::same_bits(nested.state.particles.rest_position[0], first_rest_x));
            nested.state.particles.id = first_id;
            support::advance(120 / solver::substeps(problem), nested);
            EXPECT_EQ(single.state.clock.time, nested.state.clock.time);
            expect_same(single, nested);
        }
    }
}

TEST(SameBits, for_any_number_of_threads)
{
    for (const Scheme& scheme : schemes) {
        SCOPED_TRACE(scheme.name);
        const solver::Problem problem = refined_torn_bar(scheme.numerics, scheme.nonlocal_radius);
        Job one = run_on(1, problem, 200);
        EXPECT_GT(one.state.particles.cracks.size(), 0U);
        if (scheme.nonlocal_radius > 0) {
            const particles::Column& remembered = one.state.particles.lode_strain;
            EXPECT_GT(*std::max_element(remembered.begin(), remembered.end()), 0);
        }
        for (const int threads : {2, 4}) {
            Job many = run_on(threads, problem, 200);
            expect_same(one, many);
            test::expect_same_levels(one.state.particles, many.state.particles);
            EXPECT_EQ(one.state.particles.id, many.state.particles.id);
            EXPECT_EQ(solver::audit(one.prepared, one.state).residual(),
                      solver::audit(many.prepared, many.state).residual());
        }
    }
}

TEST(SameBits, after_a_restart_at_any_step)
{
    for (const Scheme& scheme : schemes) {
        Job run = torn(refined_torn_bar(scheme.numerics, scheme.nonlocal_radius));
        std::size_t cracks_before = 0, cracks_after = 0; // restarts that find cracks, and that see some start
        for (int n = 0; n < 20; ++n) {
            support::advance(n < 6 ? 1 : 7, run);
            const std::size_t cracks = run.state.particles.cracks.size();
            Job straight = run, restarted = support::resumed(run);
            support::advance(2, straight);
            support::advance(2, restarted);
            expect_same(straight, restarted);
            test::expect_same_levels(straight.state.particles, restarted.state.particles);
            cracks_before += cracks > 0 ? 1 : 0;
            cracks_after += straight.state.particles.cracks.size() > cracks ? 1 : 0;
            ASSERT_FALSE(HasFailure()) << scheme.name << " after step " << run.state.clock.step;
        }
        EXPECT_GT(cracks_before, 0U) << scheme.name;
        EXPECT_LT(cracks_before, 20U) << scheme.name;
        EXPECT_GT(cracks_after, 0U) << scheme.name;
    }
}

// The sums a step starts from are those `scatter` finds, also in the step in which a crack begins.
TEST(SameBits, sums_after_a_step_are_those_of_a_fresh_scatter)
{
    for (const Scheme& scheme : schemes) {
        if (scheme.numerics.transfer == solver::Transfer::nodal) continue; // nothing is mapped after the first step
        Job run = torn(refined_torn_bar(scheme.numerics, scheme.nonlocal_radius));
        for (int n = 0; n < 150; ++n) {
            support::advance(1, run);
            grid::Levels again = run.state.levels;
            transfer::scatter(run.prepared.options, run.prepared.laws, run.state.strays, run.state.particles, again);
            ASSERT_TRUE(test::same_bits(again.sum, run.state.levels.sum)) << "step " << n;
        }
        EXPECT_GT(run.state.particles.cracks.size(), 0U);
    }
}
