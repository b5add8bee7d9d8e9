// Energy ledger, frame invariance, time step and gauges of whole runs.
#include "core/error.h"
#include "solver/audit.h"
#include "solver/follow.h"
#include "solver/observe.h"
#include "solver/stable_time_step.h"
#include "tests/support/runs.h"
#include "transfer/cell_squeeze.h"

#include <gtest/gtest.h>

using support::Job;

namespace
{
constexpr solver::Formulation formulations[] = {solver::Formulation::updated, solver::Formulation::total};

const solver::Numerics schemes[] = {
    support::numerics(solver::Formulation::updated),
    support::numerics(solver::Formulation::total),
    support::nodal_numerics(solver::Precision::f64),
    support::nodal_numerics(solver::Precision::mixed),
};

/// Stretch the bar to time `end` and return the ledger.
solver::Ledger pulled(solver::Problem problem, Real end)
{
    Job run = support::started(problem);
    while (run.state.clock.time < end) support::advance(1, run);
    return solver::audit(run.prepared, run.state);
}
} // namespace

TEST(Energy, a_smooth_elastic_pull_stores_the_work_of_the_loads)
{
    for (const solver::Transfer transfer : {solver::Transfer::flip, solver::Transfer::nodal})
        for (const bool refined : {false, true}) {
            solver::Problem problem = support::bar(support::metal(), 0.02, 0.4);
            problem.numerics.transfer = transfer;
            problem.numerics.cfl = 0.25; // work and energy are taken half a step apart
            if (refined) {
                problem.grid.levels = 2;
                problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
            }
            const solver::Ledger ledger = pulled(problem, 0.6);
            EXPECT_GT(ledger.external, 0);
            EXPECT_GT(ledger.elastic / ledger.external, 0.9);
            EXPECT_LT(std::abs(ledger.residual()) / ledger.external, 1e-3) << refined;
        }
}

TEST(Energy, a_plastic_pull_closes_the_ledger)
{
    material::Material metal = support::metal();
    metal.plastic = material::VonMises{10, 50};
    for (const solver::Numerics& numerics : schemes) {
        solver::Problem problem = support::bar(metal, 1, 0.1);
        problem.numerics = numerics;
        const solver::Ledger ledger = pulled(problem, 0.6);
        EXPECT_GT(ledger.plastic / ledger.external, 0.5);
        EXPECT_LT(std::abs(ledger.residual()) / ledger.external, 0.01);
    }
}

namespace
{
/// Share of the energy a freely vibrating bar loses in 0.05 ms.
Real loss_of_free_bar(Real cell)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.loads.clear();
    problem.grid.cell = cell;
    Job run = support::started(problem);
    for (std::size_t p = 0; p < run.state.particles.size(); ++p)
        run.state.particles.velocity[1][p] = 0.5 * (run.state.particles.position[1][p] - 2);
    transfer::scatter(run.prepared.options, run.prepared.laws, run.state.strays, run.state.particles, run.state.levels);
    const Real before = solver::audit(run.prepared, run.state).kinetic;
    while (run.state.clock.time < 0.05) support::advance(1, run);
    EXPECT_LT(solver::momentum(run.state.particles).norm(), 1e-12);
    const solver::Ledger after = solver::audit(run.prepared, run.state);
    return 1 - (after.kinetic + after.elastic) / before;
}
} // namespace

// A.4, 13. FLIP with the stress updated last damps a wave at the rate dt w^2 (k h)^2: it never gains energy, and the
// loss of a given mode falls with the third power of the cell size.
TEST(Energy, a_free_elastic_body_gains_no_energy_and_loses_less_on_finer_cells)
{
    const Real coarse = loss_of_free_bar(0.5), fine = loss_of_free_bar(0.25);
    EXPECT_GT(fine, 0);
    EXPECT_LT(fine, coarse / 3);
}

namespace
{
/// Energy of a freely vibrating bar over 1 ms, about 60 periods, in the nodal scheme.
struct Vibration
{
    Real largest = 0;         // of |E / E_0 - 1|
    Real first = 0, last = 0; // mean of E / E_0 - 1 over the first and the last fifth
};

Vibration vibration(Real cfl, solver::Precision precision, bool subcycling = false)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.loads.clear();
    problem.numerics = support::nodal_numerics(precision);
    problem.numerics.cfl = cfl;
    problem.numerics.subcycling = subcycling;
    if (subcycling) {
        problem.grid.levels = 2;
        problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
    }
    Job run = support::started(problem);
    support::restart_with(
        [](particles::Particles& particles) {
            for (std::size_t p = 0; p < particles.size(); ++p)
                particles.velocity[1][p] = 0.5 * (particles.position[1][p] - 2);
        },
        run);
    run.state.initial_energy = solver::audit(run.prepared, run.state).kinetic;
    const Real end = 1;
    Vibration v;
    int early = 0, late = 0;
    while (run.state.clock.time < end) {
        support::advance(1, run);
        const Real gained = -solver::audit(run.prepared, run.state).residual() / run.state.initial_energy;
        v.largest = std::max(v.largest, std::abs(gained));
        if (run.state.clock.time < 0.2 * end) v.first += gained, ++early;
        if (run.state.clock.time > 0.8 * end) v.last += gained, ++late;
    }
    v.first /= early;
    v.last /= late;
    return v;
}
} // namespace

// Symplectic Euler conserves E - dt/2 f v + O(dt^2) exactly: E swings about it with an amplitude of first order and
// drifts nowhere. Velocity never leaves the nodes, so nothing is smoothed away.
TEST(Energy, a_free_elastic_body_keeps_its_energy_in_the_nodal_scheme)
{
    for (const solver::Precision precision : {solver::Precision::f64, solver::Precision::mixed}) {
        const Vibration coarse = vibration(0.4, precision), fine = vibration(0.1, precision);
        EXPECT_LT(coarse.largest, 0.25);
        EXPECT_NEAR(coarse.largest / fine.largest, 4, 0.8);
        EXPECT_LT(std::abs(coarse.last - coarse.first), 0.01);
        EXPECT_LT(std::abs(fine.last - fine.first), 0.0025);
    }
}

TEST(Energy, a_free_elastic_body_keeps_its_energy_with_subcycling)
{
    const Vibration coarse = vibration(0.5, solver::Precision::f64, true),
                    fine = vibration(0.125, solver::Precision::f64, true);
    EXPECT_LT(coarse.largest, 0.3);
    EXPECT_NEAR(coarse.largest / fine.largest, 4, 0.8);
    EXPECT_LT(std::abs(coarse.last - coarse.first), 0.01);
    EXPECT_LT(std::abs(fine.last - fine.first), 0.0025);
}

// A.4, 12: a moving frame reproduces the run at rest. The total formulation never sees the grid move; in the updated
// one the lattice is carried along by hand.
TEST(Energy, a_frame_in_motion_changes_nothing)
{
    const Vec3 frame(30, -20, 10); // mm/ms
    for (const solver::Numerics& numerics : schemes) {
        // Velocities of the nodes reach the particles in single precision as differences.
        const Real rounding = numerics.precision == solver::Precision::mixed ? 1e-5 : 1e-10;
        solver::Problem problem = support::bar(support::metal(), 0, 0);
        problem.loads.clear();
        problem.numerics = numerics;
        problem.numerics.stress_update = solver::StressUpdate::usl;
        const auto disturbed = [&](const Vec3& velocity) {
            problem.bodies[0].velocity = velocity;
            Job run = support::started(problem);
            support::restart_with(
                [](particles::Particles& particles) {
                    for (std::size_t p = 0; p < particles.size(); ++p)
                        particles.velocity[1][p] += 0.5 * (particles.rest_position[1][p] - 2);
                },
                run);
            return run;
        };
        Job rest = disturbed(Vec3::Zero()), moving = disturbed(frame);
        for (int n = 0; n < 100; ++n) {
            support::advance(1, rest);
            support::advance(1, moving);
            ASSERT_EQ(rest.state.clock.dt, moving.state.clock.dt);
            if (numerics.formulation == solver::Formulation::total) continue;
            moving.state.levels.origin = frame * moving.state.clock.time;
            solver::regrid(rest.problem, rest.prepared, rest.state, rest.derived);
            solver::regrid(moving.problem, moving.prepared, moving.state, moving.derived);
        }
        ASSERT_EQ(rest.state.particles.id, moving.state.particles.id);
        const particles::Particles still = support::particles_of(rest), carried = support::particles_of(moving);
        Real velocity = 0, stress = 0, largest = 0;
        for (std::size_t p = 0; p < still.size(); ++p) {
            for (std::size_t a = 0; a < 3; ++a)
                velocity = std::max(
                    velocity, std::abs(carried.velocity[a][p] - frame[static_cast<int>(a)] - still.velocity[a][p]));
            for (std::size_t c = 0; c < 6; ++c) {
                stress = std::max(stress, std::abs(carried.stress[c][p] - still.stress[c][p]));
                largest = std::max(largest, std::abs(still.stress[c][p]));
            }
        }
        EXPECT_LT(velocity, rounding);
        EXPECT_LT(stress, 10 * rounding * largest);
    }
}

TEST(StableTimeStep, is_the_wave_transit_of_the_finest_cell_and_shrinks_with_compression)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
    Job run = support::started(problem);
    const Real transit = 0.25 / run.prepared.wave_speed;
    EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state), 0.5 * transit, 1e-15);

    // Half as long along y, on the coarse and then on the fine cells.
    const auto compress = [&](int level, Real stretch) {
        for (std::size_t p = 0; p < run.state.particles.size(); ++p)
            if (run.state.particles.size_level[p] == level) run.state.particles.deformation_gradient[4][p] = stretch;
    };
    compress(0, 0.5);
    EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state), 0.5 * transit, 1e-15);
    compress(1, 0.5);
    EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state),
                transfer::deformed_step_share * std::sqrt(0.5) * transit, 1e-15);
    compress(1, -0.1);
    EXPECT_THROW((void)solver::stable_time_step(run.problem, run.prepared, run.state), core::NumericalError);
}

// The same from the displacement of the nodes: half as long along y.
TEST(StableTimeStep, shrinks_with_compression_of_the_nodes)
{
    for (const solver::Precision precision : {solver::Precision::f64, solver::Precision::mixed}) {
        solver::Problem problem = support::bar(support::metal(), 0, 0);
        problem.numerics = support::nodal_numerics(precision);
        Job run = support::started(problem);
        const Real transit = 0.5 / run.prepared.wave_speed;
        EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state), 0.5 * transit, 1e-15);
        const auto stretch_to = [&](Real length) {
            grid::Levels& levels = run.state.levels;
            for (std::size_t n = 0; n < levels.leaves.size(); ++n)
                for (int node = 0; node < grid::tile_nodes; ++node)
                    levels.motions(n)[node].change[1] =
                        (length - 1) * 0.5 * (levels.leaves[n].origin[1] + node / grid::tile_side % grid::tile_side);
        };
        stretch_to(0.5);
        EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state),
                    transfer::deformed_step_share * std::sqrt(0.5) * transit, 1e-9);
        stretch_to(-0.1);
        EXPECT_THROW((void)solver::stable_time_step(run.problem, run.prepared, run.state), core::NumericalError);
        stretch_to(1);
        run.state.levels.motions(0)[grid::tile_index(1, 1, 1)].velocity[1] = std::numeric_limits<Real>::quiet_NaN();
        EXPECT_THROW(support::advance(2 * solver::time_step_interval, run), core::NumericalError);
    }
}

// Each level is held to its own step: squeezed coarse cells shorten the step like fine ones.
TEST(StableTimeStep, of_every_level_with_subcycling)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
    problem.numerics = support::subcycled_numerics(solver::Precision::f64);
    Job run = support::started(problem);
    const Real transit = 0.25 / run.prepared.wave_speed;
    EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state), 0.5 * transit, 1e-15);
    support::advance(1, run);
    EXPECT_NEAR(run.state.clock.dt, transit, 1e-15);
    EXPECT_EQ(run.state.clock.time, run.state.clock.dt);
    for (const int level : {0, 1}) {
        Job squeezed = run;
        grid::Levels& levels = squeezed.state.levels;
        const Real spacing = levels.spacing(level);
        for (std::size_t n = levels.first_leaf(level); n < levels.first_leaf(level + 1); ++n)
            for (int node = 0; node < grid::tile_nodes; ++node)
                levels.motions(n)[node].change[1] =
                    -0.5 * spacing * (levels.leaves[n].origin[1] + node / grid::tile_side % grid::tile_side);
        // Half as wide along one axis: half of the volume to be stiff with.
        EXPECT_NEAR(solver::stable_time_step(squeezed.problem, squeezed.prepared, squeezed.state),
                    solver::subcycled_step_share * std::sqrt(0.5) * transit, 1e-9);
    }
}

TEST(StableTimeStep, shrinks_with_speed_in_the_updated_formulation)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.numerics.formulation = solver::Formulation::updated;
    problem.loads.clear();
    problem.bodies[0].velocity = {0, 1000, 0};
    Job run = support::started(problem);
    EXPECT_NEAR(solver::stable_time_step(run.problem, run.prepared, run.state),
                transfer::deformed_step_share * 0.5 / (run.prepared.wave_speed + 1000), 1e-15);
}

// A run whose step goes to nothing never ends: below a thousandth of the step at rest it stops and says where.
TEST(StableTimeStep, ends_the_run_where_a_cell_is_squeezed_to_nothing)
{
    Job run = support::started(support::bar(support::metal(), 0, 0));
    Real& stretch = run.state.particles.deformation_gradient[4][7];
    stretch = 1e-4;
    EXPECT_NO_THROW((void)solver::stable_time_step(run.problem, run.prepared, run.state));
    stretch = 1e-8;
    try {
        (void)solver::stable_time_step(run.problem, run.prepared, run.state);
        FAIL() << "no error";
    } catch (const core::NumericalError& error) {
        const std::string text = error.what();
        const std::string id = std::to_string(run.state.particles.id[7]);
        for (const std::string& part : {"particle " + id + " from (", std::string("waves pass it 10000 times as fast"),
                                        std::string("at step 0"), std::string("level 0")})
            EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    }
}

TEST(StableTimeStep, ends_the_run_where_nodes_squeeze_a_cell_to_nothing)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.numerics = support::nodal_numerics(solver::Precision::f64);
    Job run = support::started(problem);
    grid::Levels& levels = run.state.levels;
    for (std::size_t n = 0; n < levels.leaves.size(); ++n)
        for (int node = 0; node < grid::tile_nodes; ++node)
            levels.motions(n)[node].change[1] =
                (1e-8 - 1) * 0.5 * (levels.leaves[n].origin[1] + node / grid::tile_side % grid::tile_side);
    EXPECT_THROW((void)solver::stable_time_step(run.problem, run.prepared, run.state), core::NumericalError);
}

TEST(StableTimeStep, ends_the_run_where_a_particle_is_thrown_away)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.numerics.formulation = solver::Formulation::updated;
    problem.loads.clear();
    Job run = support::started(problem);
    run.state.particles.velocity[1][7] = 1e4 * run.prepared.wave_speed;
    try {
        (void)solver::stable_time_step(run.problem, run.prepared, run.state);
        FAIL() << "no error";
    } catch (const core::NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find("the speed of sound is"), std::string::npos) << error.what();
    }
}

TEST(StableTimeStep, names_the_particle_that_is_not_finite)
{
    for (const solver::Formulation formulation : formulations) {
        solver::Problem problem = support::bar(support::metal(), 0, 0);
        problem.numerics.formulation = formulation;
        Job run = support::started(problem);
        run.state.particles.velocity[1][7] = std::numeric_limits<Real>::quiet_NaN();
        try {
            support::advance(1, run);
            FAIL() << "no error";
        } catch (const core::NumericalError& error) {
            const std::string id = std::to_string(run.state.particles.id[7]);
            EXPECT_EQ(std::string(error.what()).find("particle " + id + " has no finite motion at step 0"), 0U)
                << error.what();
        }
    }
}

TEST(StableTimeStep, a_position_that_is_not_finite_stops_the_updated_formulation)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.numerics.formulation = solver::Formulation::updated;
    Job run = support::started(problem);
    support::advance(1, run);
    for (Real& v : run.state.particles.velocity[1]) v = std::numeric_limits<Real>::quiet_NaN();
    transfer::scatter(run.prepared.options, run.prepared.laws, run.state.strays, run.state.particles, run.state.levels);
    EXPECT_THROW(support::advance(1, run), core::NumericalError); // not a multiple of time_step_interval
}

TEST(Gauge, measures_the_change_of_distance_between_two_places)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.gauge = solver::Gauge{{1, 3, 0.5}, {1, 1, 0.5}, 1};
    Job run = support::started(problem);
    EXPECT_EQ(solver::gauge_opening(run.problem, run.state, run.derived), 0);
    for (std::size_t p = 0; p < run.state.particles.size(); ++p)
        run.state.particles.position[1][p] += 0.01 * run.state.particles.rest_position[1][p];
    EXPECT_NEAR(solver::gauge_opening(run.problem, run.state, run.derived), 0.02, 1e-12);
}

TEST(Gauge, measures_the_displacement_of_the_nodes)
{
    solver::Problem problem = support::bar(support::metal(), 5, 0.01);
    problem.gauge = solver::Gauge{{1, 3, 0.5}, {1, 1, 0.5}, 1};
    problem.numerics = support::nodal_numerics(solver::Precision::f64);
    Job run = support::started(problem);
    support::advance(100, run);
    const particles::Particles particles = support::particles_of(run);
    const auto mean = [&](const std::vector<std::uint32_t>& places) {
        Real sum = 0;
        for (const std::uint32_t p : places) sum += particles.position[1][p] - particles.rest_position[1][p];
        return sum / static_cast<Real>(places.size());
    };
    const Real expected = mean(run.derived.gauge_upper) - mean(run.derived.gauge_lower);
    EXPECT_GT(expected, 1e-3);
    EXPECT_NEAR(solver::gauge_opening(run.problem, run.state, run.derived), expected, 1e-14);
}
