// Loads on surfaces and body forces: totals, what they do, and that a run goes on with the same bits after a restart.
#include "solver/external_force.h"

#include "solver/audit.h"
#include "tests/solver/free_bar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using support::Job;

namespace
{
using Kind = solver::SurfaceLoad::Kind;
using test::surface_load;

solver::SurfaceForces forces_of(const solver::Problem& problem)
{
    Job run = support::started(problem);
    return run.derived.surface;
}
} // namespace

TEST(SurfaceForces, of_a_plane_face_are_exact_whatever_the_cells)
{
    for (const Real cell : {0.5, 0.3, 0.7}) { // the last two cut the face
        solver::Problem problem = test::free_bar(cell);
        problem.surface_loads = {surface_load(Kind::traction, support::beyond(1, 3, 1), 0, {3, 5, 7})};
        problem.surface_loads[0].facing = Vec3(0, 1, 0);
        const solver::SurfaceForces surface = forces_of(problem);
        EXPECT_NEAR(surface.area[0], 2, 0.07)
            << cell; // shares from 4^3 samples: an edge is known to an eighth of a sub-cell
        EXPECT_LT((surface.total[0] - surface.area[0] * Vec3(3, 5, 7)).norm(), 1e-12);
        problem.surface_loads[0].kind = Kind::force;
        EXPECT_LT((forces_of(problem).total[0] - Vec3(3, 5, 7)).norm(), 1e-12) << cell;
    }
    solver::Problem problem = test::free_bar(0.5);
    problem.surface_loads = {surface_load(Kind::pressure, support::beyond(1, 3.9, 1), 10, Vec3::Zero())};
    problem.surface_loads[0].facing = Vec3(0, 1, 0);
    EXPECT_LT((forces_of(problem).total[0] - Vec3(0, -20, 0)).norm(), 1e-12);
}

TEST(SurfaceForces, do_not_push_on_symmetry_planes_or_level_interfaces)
{
    solver::Problem problem = test::free_bar(0.5);
    problem.symmetry = {{0, 0}};
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, -1, -1}, {1, 2.1, 2}), 1)};
    problem.surface_loads = {surface_load(Kind::pressure, support::everywhere(), 10, Vec3::Zero())};
    const solver::SurfaceForces surface = forces_of(problem);
    // All faces but x = 0: what pushes on x = 2 is not balanced.
    EXPECT_LT((surface.total[0] - Vec3(-40, 0, 0)).norm(), 1e-9);
}

TEST(SurfaceForces, in_a_hole_are_its_projected_area)
{
    const Real radius = 1.3;
    const geometry::Shape hole = geometry::cylinder({0, 0, -1}, {0, 0, 2}, radius);
    solver::Problem problem = test::free_bar(0.25);
    problem.symmetry = {{0, 0}, {1, 0}};
    problem.bodies[0].shape = geometry::subtract(geometry::box({0, 0, 0}, {3, 3, 1}), {hole});
    problem.surface_loads = {
        surface_load(Kind::pressure, geometry::cylinder({0, 0, 0.01}, {0, 0, 0.99}, radius + 0.3), 10, Vec3::Zero())};
    const Vec3 total = forces_of(problem).total[0];
    EXPECT_NEAR(total[0], 10 * radius, 0.01 * 10 * radius);
    EXPECT_NEAR(total[1], 10 * radius, 0.01 * 10 * radius);
    EXPECT_EQ(total[2], 0);
}

TEST(ExternalForce, accelerates_a_free_body_by_its_total_and_does_the_work_it_gains)
{
    for (const solver::Numerics& numerics : test::schemes) {
        solver::Problem problem = test::free_bar(0.5);
        problem.numerics = numerics;
        test::add_fine_corner(problem);
        problem.surface_loads = {surface_load(Kind::traction, support::beyond(0, 1.6, 1), 0, {3, 0, 0})};
        problem.surface_loads[0].facing = Vec3(1, 0, 0);
        Job run = support::started(problem);
        support::advance(60, run);
        const Vec3 momentum = solver::momentum(support::particles_of(run));
        const Real tolerance = numerics.precision == solver::Precision::mixed ? 1e-5 : 1e-8;
        EXPECT_NEAR(momentum[0] / (12 * run.state.clock.time), 1, tolerance);
        const solver::Ledger ledger = solver::audit(run.prepared, run.state);
        EXPECT_GT(ledger.external, 0);
        EXPECT_LT(std::abs(ledger.residual()), 0.05 * ledger.external) << static_cast<int>(numerics.transfer);
    }
}

TEST(ExternalForce, goes_on_with_the_same_bits_after_a_restart)
{
    for (const solver::Numerics& numerics : test::schemes) {
        solver::Problem problem = test::free_bar(0.5);
        problem.numerics = numerics;
        problem.numerics.damping = 3;
        test::add_fine_corner(problem);
        problem.motions = {{"spin", problem.materials[0].elastic, solver::Spin{{1, 2, 0.5}, 2, 15, {30, 0, 0}}}};
        problem.bodies[0].initial = 0;
        problem.bodies[0].body_force = 0;
        problem.surface_loads = {surface_load(Kind::pressure, support::beyond(1, 3, 1), 5, Vec3::Zero())};
        problem.surface_loads[0].ramp = {solver::Ramp::Kind::linear, 0.05};
        Job run = support::started(problem);
        support::advance(70, run);
        test::expect_same_bits_after_a_restart(40, run);
        EXPECT_NE(run.state.source_work, 0);
    }
}
