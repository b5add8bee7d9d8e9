#include "solver/loads.h"

#include "core/error.h"
#include "solver/audit.h"
#include "solver/observe.h"
#include "tests/support/runs.h"
#include "tests/support/topologies.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <set>

using solver::Ramp;
using support::Job;

namespace
{
std::string complaint(const solver::Problem& problem)
{
    try {
        (void)support::started(problem);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

Vec3 sum_of_impulses(const Job& run)
{
    Vec3 sum = Vec3::Zero();
    for (const solver::LoadState& load : run.state.loads) sum += load.impulse;
    return sum;
}

Real mass_of(const Job& run)
{
    Real mass = 0;
    for (const Real m : run.state.particles.mass) mass += m;
    return mass;
}

/// Angular momentum of the particles about the z axis through the origin.
Real angular_momentum(const particles::Particles& particles)
{
    Real sum = 0;
    for (std::size_t p = 0; p < particles.size(); ++p)
        sum += particles.mass[p] * (particles.position[0][p] * particles.velocity[1][p] -
                                    particles.position[1][p] * particles.velocity[0][p]);
    return sum;
}

/// `visit(x, momentum)` for the free nodes with mass; nodal scheme.
template <class Visit>
void for_each_momentum(const Job& run, const Visit& visit)
{
    support::for_each_free_node(run.state.levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        const grid::NodeForce& force = run.state.levels.forces(leaf)[at.node];
        const auto& v = run.state.levels.motions(leaf)[at.node].velocity;
        if (force.per_mass > 0) visit(x, Vec3(v[0], v[1], v[2]) / force.per_mass);
    });
}

/// Angular momentum of the nodes about the z axis through the origin; nodal scheme.
Real moment_of(const Job& run)
{
    Real sum = 0;
    for_each_momentum(run,
                      [&](const Vec3& x, const Vec3& momentum) { sum += x[0] * momentum[1] - x[1] * momentum[0]; });
    return sum;
}

/// Momentum of the nodes, or of the particles where they carry it.
Vec3 momentum_of(const Job& run)
{
    if (!solver::nodal(run.problem)) return solver::momentum(run.state.particles);
    Vec3 sum = Vec3::Zero();
    for_each_momentum(run, [&](const Vec3&, const Vec3& momentum) { sum += momentum; });
    return sum;
}

/// `check(problem, tolerance)` with every formulation, transfer, share of PIC and stress update. In single precision
/// the forces of a cell's corners cancel to its rounding only.
template <class Check>
void for_each_scheme(solver::Problem problem, const Check& check)
{
    for (const auto formulation : {solver::Formulation::updated, solver::Formulation::total})
        for (const auto update : {solver::StressUpdate::usl, solver::StressUpdate::musl})
            for (const Real pic : {-1.0, 0.0, 0.3}) {
                problem.numerics.formulation = formulation;
                problem.numerics.stress_update = update;
                problem.numerics.transfer = pic < 0 ? solver::Transfer::apic : solver::Transfer::flip;
                problem.numerics.pic_fraction = std::max(pic, Real(0));
                check(problem, 1e-12);
            }
    problem.numerics = support::nodal_numerics(solver::Precision::f64);
    check(problem, 1e-12);
    problem.numerics = support::nodal_numerics(solver::Precision::mixed);
    check(problem, 1e-6);
}

/// The body moves, and all of its momentum comes from the loads.
void expect_momentum_from_loads(const solver::Problem& problem, Real tolerance)
{
    Job run = support::started(problem);
    support::advance(60, run);
    const Vec3 momentum = momentum_of(run);
    EXPECT_GT(momentum.norm(), 0.01 * mass_of(run));
    EXPECT_LT((momentum - sum_of_impulses(run)).norm(), tolerance * mass_of(run));
}
} // namespace

TEST(Ramp, smooth_step_starts_and_ends_without_slope_or_curvature)
{
    const Ramp ramp{Ramp::Kind::smooth_step, 2};
    EXPECT_EQ(solver::ramp_value(ramp, -1), 0);
    EXPECT_EQ(solver::ramp_value(ramp, 0), 0);
    EXPECT_NEAR(solver::ramp_value(ramp, 1), 0.5, 1e-15);
    EXPECT_EQ(solver::ramp_value(ramp, 2), 1);
    EXPECT_EQ(solver::ramp_value(ramp, 3), 1);
    const Real e = 1e-4;
    for (const Real end : {0.0, 2.0}) {
        const auto value = [&](Real t) { return solver::ramp_value(ramp, end + t); };
        EXPECT_LT(std::abs(value(e) - value(-e)) / (2 * e), 1e-7);
        EXPECT_LT(std::abs(value(e) - 2 * value(0) + value(-e)) / (e * e), 1e-2);
    }
    for (Real t = 0; t < 2; t += 0.01) EXPECT_LE(solver::ramp_value(ramp, t), solver::ramp_value(ramp, t + 0.01));
}

TEST(Ramp, linear_and_step)
{
    EXPECT_NEAR(solver::ramp_value({Ramp::Kind::linear, 4}, 1), 0.25, 1e-15);
    EXPECT_EQ(solver::ramp_value({Ramp::Kind::linear, 4}, 5), 1);
    EXPECT_EQ(solver::ramp_value({Ramp::Kind::step, 4}, 0), 1);
    EXPECT_EQ(solver::ramp_value({Ramp::Kind::smooth_step, 0}, 0), 1);
}

TEST(Loads, reactions_are_the_momentum_that_regions_give_the_body)
{
    for_each_scheme(support::bar(support::metal(), 5, 0.01), expect_momentum_from_loads);
}

// Three loads hold nodes of one end: the last one moves them, and nobody's force counts twice.
TEST(Loads, reactions_are_the_momentum_where_loads_share_nodes)
{
    solver::Problem bar = support::bar(support::metal(), 5, 0.01);
    for (const Real share : {0.5, 1.5}) {
        solver::Load other = bar.loads[1];
        other.name += other.name;
        for (std::optional<Real>& component : other.velocity)
            if (component) *component *= share;
        bar.loads.push_back(other);
    }
    for_each_scheme(bar, expect_momentum_from_loads);
}

TEST(Loads, reactions_are_the_momentum_that_pins_give_the_body)
{
    solver::Problem plate = support::plate(support::metal(), 5, 0.01);
    plate.loads[1].velocity = {1.0, 2.0, {}};
    for_each_scheme(plate, expect_momentum_from_loads);
}

// Sub-cycled: a pin that holds nodes of two levels, some of them masters, and a region on the coarsest of three.
TEST(Loads, reactions_are_the_momentum_of_a_subcycled_body)
{
    for (const int levels : {2, 3})
        for (const auto precision : {solver::Precision::f64, solver::Precision::mixed}) {
            solver::Problem problem = support::plate(support::metal(), 5, 0.01);
            problem.loads[1] = support::load("bottom", support::beyond(1, -3, -1), {1.0, 2.0, {}}, 0.01);
            problem.numerics = support::subcycled_numerics(precision);
            problem.grid.levels = levels;
            problem.zones = {support::zone(geometry::box({0.3, -5, -1}, {4, 5, 2}), 1)};
            if (levels == 3) problem.zones.push_back(support::zone(geometry::box({1.2, -1, -1}, {4, 5, 2}), 2));
            Job run = support::started(problem);
            std::set<int> held;
            for (const grid::NodeAddress& at : run.derived.load_nodes[0].node)
                held.insert(run.state.levels.leaves[static_cast<std::size_t>(at.leaf)].level);
            EXPECT_GT(held.size(), 1U);
            support::advance(40, run);
            const Vec3 momentum = momentum_of(run);
            EXPECT_GT(momentum.norm(), 0.01 * mass_of(run));
            EXPECT_LT((momentum - sum_of_impulses(run)).norm(),
                      (precision == solver::Precision::mixed ? 1e-6 : 1e-12) * mass_of(run));
            // Held nodes have the velocity and the displacement of their load, on every level.
            const Real speed = 2 * solver::ramp_value(run.problem.loads[1].ramp, run.state.clock.time);
            for (const grid::NodeAddress& at : run.derived.load_nodes[1].node) {
                const grid::NodeMotion& motion = run.state.levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
                EXPECT_NEAR(motion.velocity[1], speed, 1e-14);
                EXPECT_NEAR(motion.change[1], run.state.loads[1].displacement[1], 1e-14);
            }
        }
}

TEST(Loads, a_symmetric_specimen_loads_both_pins_alike)
{
    for (const auto transfer : {solver::Transfer::flip, solver::Transfer::nodal}) {
        solver::Problem problem = support::plate(support::metal(), 2, 0.05);
        problem.numerics.transfer = transfer;
        Job run = support::started(problem);
        support::advance(300, run);
        const Real upper = run.state.loads[0].impulse[1], lower = run.state.loads[1].impulse[1];
        EXPECT_GT(upper, 0);
        EXPECT_NEAR(upper, -lower, 1e-10 * upper);
        EXPECT_NEAR(run.state.loads[0].spin, 0, 1e-10);
        const solver::HistoryLine line = solver::observe(run.problem, run.prepared, run.derived, run.state);
        EXPECT_NEAR(line.force_upper, line.force_lower, 1e-10 * line.force_upper);
        EXPECT_NEAR(line.force_upper, upper / run.state.clock.time, 1e-12 * line.force_upper);
    }
}

TEST(Loads, symmetry_planes_count_the_other_half_of_the_force)
{
    solver::Problem whole = support::bar(support::metal(), 2, 0.02);
    whole.bodies[0].shape = geometry::box({-2, 0, 0}, {2, 4, 1});
    solver::Problem half = support::bar(support::metal(), 2, 0.02);
    half.symmetry = {{0, 0}};
    Real force[2];
    for (const bool halved : {false, true}) {
        Job run = support::started(halved ? half : whole);
        support::advance(200, run);
        force[halved] = solver::observe(run.problem, run.prepared, run.derived, run.state).force_upper;
    }
    EXPECT_NEAR(force[0], force[1], 1e-9 * force[0]);
}

// A body that spins about a pin at rest: nothing turns the pin, so its spin and the angular momentum stay.
TEST(Loads, a_pin_turns_freely)
{
    using enum solver::Formulation;
    using enum solver::Transfer;
    struct Scheme
    {
        const char* name;
        solver::Formulation formulation;
        solver::Transfer transfer;
    };
    for (const Scheme& scheme :
         {Scheme{"total flip", total, flip}, Scheme{"total apic", total, apic}, Scheme{"updated flip", updated, flip},
          Scheme{"updated apic", updated, apic}, Scheme{"nodal", total, nodal}})
    {
        SCOPED_TRACE(scheme.name);
        // Faster, and particles of the updated formulation that enter empty cells at the rim blow up (methods.md
        // B4).
        const Real spin = scheme.formulation == updated ? 1 : 20; // rad/ms
        solver::Problem problem = support::plate(support::metal(), 0, 0);
        problem.bodies[0].shape = geometry::subtract(geometry::cylinder({0, 0, 0}, {0, 0, 1}, 3),
                                                     {support::pin("", {0, 0, 0}, 1, {}, 0).region});
        problem.loads = {support::pin("pin", {0, 0, 0}, 1, {0.0, 0.0, {}}, 0)};
        problem.force_upper = problem.force_lower = "pin";
        problem.numerics = support::numerics(scheme.formulation);
        problem.numerics.transfer = scheme.transfer;
        Job run = support::started(problem);
        support::restart_with(
            [&](particles::Particles& particles) {
                for (std::size_t p = 0; p < particles.size(); ++p) {
                    particles.velocity[0][p] = -spin * particles.position[1][p];
                    particles.velocity[1][p] = spin * particles.position[0][p];
                    if (scheme.transfer != apic) continue;
                    particles.affine[1][p] = -spin;
                    particles.affine[3][p] = spin;
                }
            },
            run);
        run.state.loads[0].spin = spin;
        const Real before = angular_momentum(support::particles_of(run));
        support::advance(200, run);
        EXPECT_NEAR(run.state.loads[0].angle / (spin * run.state.clock.time), 1, 0.03);
        EXPECT_NEAR(angular_momentum(support::particles_of(run)) / before, 1, 0.02);
    }
}

// At rest, then pulled: whatever the held nodes get has no moment about the pin, though they lie to one side of it.
TEST(Loads, a_pin_that_speeds_up_has_no_moment)
{
    solver::Problem problem = support::plate(support::metal(), 0, 0);
    problem.bodies[0].shape = geometry::box({-3, 0, 0}, {3, 4, 1});
    problem.loads = {support::pin("pin", {0, 0, 0}, 1, {2.0, 5.0, {}}, 0.01)};
    problem.force_upper = problem.force_lower = "pin";
    problem.numerics.transfer = solver::Transfer::nodal;
    Job run = support::started(problem);
    support::advance(1, run);
    const Vec3 given = run.state.loads[0].impulse;
    EXPECT_GT(given[1], 0);
    EXPECT_LT(std::abs(moment_of(run)), 1e-12 * given.norm());
    EXPECT_NE(run.state.loads[0].spin, 0);
}

TEST(Loads, a_load_that_misses_the_body_is_an_input_error)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0);
    problem.loads[0].region = geometry::box({5, 5, 5}, {6, 6, 6});
    EXPECT_EQ(complaint(problem),
              "load 'top' holds no node with mass: its region misses the body or is smaller than a cell");
}

// The end face y = 4 mm is a plane of nodes that the next leaf owns, and no particle of that leaf gives them mass.
TEST(Loads, the_end_face_of_a_body_may_be_held_where_a_leaf_ends)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0);
    problem.loads[0].region = support::beyond(1, 4, 1);
    EXPECT_EQ(complaint(problem), "");
}

// Only the plane of the end face is held: it moves off its nodes at once, and without this the force would just vanish.
TEST(Loads, a_load_that_loses_the_body_stops_the_run)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0);
    problem.numerics = support::numerics(solver::Formulation::updated);
    problem.loads[0] = support::load("top", support::beyond(1, 4, 1), {std::nullopt, Real(40), std::nullopt}, 0);
    Job run = support::started(problem);
    try {
        support::advance(400, run);
        FAIL() << "still running at t = " << run.state.clock.time << " ms";
    } catch (const core::NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find("load 'top' has lost the body at t ="), std::string::npos)
            << error.what();
    }
}

TEST(Loads, a_body_without_particles_is_an_input_error)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0);
    problem.bodies.push_back({"foil", geometry::box({0, 5, 0}, {1, 5.001, 1}), 0, Vec3::Zero()});
    EXPECT_EQ(complaint(problem),
              "body 'foil' has no particle: it is thinner than a cell of 0.5 mm, or its shape is empty");
}

TEST(Loads, a_symmetry_plane_between_nodes_is_an_input_error)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0);
    problem.symmetry = {{1, 0.2}};
    EXPECT_EQ(complaint(problem), "symmetry plane y = 0.2 mm lies between node planes of level 0 (nearest: 0 mm); move "
                                  "it or set grid.origin");
}

// Nodes of a symmetry plane stay in it, so a load that moves them along its normal would do nothing there.
TEST(Loads, a_load_that_moves_nodes_of_a_symmetry_plane_out_of_it_is_an_input_error)
{
    for (const auto transfer : {solver::Transfer::flip, solver::Transfer::nodal}) {
        solver::Problem problem = support::bar(support::metal(), 1, 0);
        problem.numerics.transfer = transfer;
        problem.symmetry = {{0, 0}, {1, 0}};
        for (const std::optional<Real>& kept : {std::optional<Real>(), std::optional<Real>(0)}) {
            problem.loads[1].velocity = {0.0, kept, 0.0};
            EXPECT_EQ(complaint(problem), "");
        }
        problem.loads[1].velocity[1] = -1;
        EXPECT_EQ(complaint(problem),
                  "load 'bottom' moves nodes of the symmetry plane y = 0 mm along y, out of the plane: let its region "
                  "end before the plane, or leave that component \"free\"");
    }
}
