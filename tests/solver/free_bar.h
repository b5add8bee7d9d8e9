/// A bar that nothing holds, what pushes it, and every scheme it can move by.
#pragma once

#include "tests/solver/same_bits.h"
#include "tests/support/runs.h"

namespace test
{
/// A bar [0, 2] x [0, 4] x [0, 1] that nothing holds.
inline solver::Problem free_bar(Real cell)
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.loads.clear();
    problem.force_upper = problem.force_lower = "";
    problem.grid.cell = cell;
    return problem;
}

/// A corner of a bar on a second level.
inline void add_fine_corner(solver::Problem& problem)
{
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, -1, -1}, {1.1, 1.9, 2}), 1)};
}

/// On faces in the region, at full size from the start.
inline solver::SurfaceLoad surface_load(solver::SurfaceLoad::Kind kind, const geometry::Shape& region, Real pressure,
                                        const Vec3& vector)
{
    solver::SurfaceLoad load;
    load.name = "push";
    load.region = region;
    load.kind = kind;
    load.pressure = pressure;
    load.vector = vector;
    load.ramp = {solver::Ramp::Kind::step, 0};
    return load;
}

/// `run` and what is left of it after a restart go on for so many steps: to the same particles, by the same work.
inline void expect_same_bits_after_a_restart(int steps, support::Job& run)
{
    support::Job again = support::resumed(run);
    support::advance(steps, run);
    support::advance(steps, again);
    expect_same_particles(support::particles_of(run), support::particles_of(again));
    EXPECT_EQ(run.state.source_work, again.state.source_work);
    EXPECT_EQ(run.state.damped_work, again.state.damped_work);
}

inline const solver::Numerics schemes[] = {
    support::numerics(solver::Formulation::updated), support::gimp_numerics(solver::Transfer::flip),
    support::gimp_numerics(solver::Transfer::apic),  support::numerics(solver::Formulation::total),
    support::nodal_numerics(solver::Precision::f64), support::nodal_numerics(solver::Precision::mixed),
};
} // namespace test
