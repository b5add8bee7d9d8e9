/// A bar that nothing holds, and every scheme it can move by.
#pragma once

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

inline const solver::Numerics schemes[] = {
    support::numerics(solver::Formulation::updated), support::gimp_numerics(solver::Transfer::flip),
    support::gimp_numerics(solver::Transfer::apic),  support::numerics(solver::Formulation::total),
    support::nodal_numerics(solver::Precision::f64), support::nodal_numerics(solver::Precision::mixed),
};
} // namespace test
