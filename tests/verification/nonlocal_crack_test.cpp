/// Crack through a bar with the onset on a ball's stress: one layer of cells separates and dissipates G_f x area,
/// however fine the cells are, and the load at onset does not depend on them (methods.md D.6, B12, C17, C18).
#include "solver/audit.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

using support::Job;

namespace
{
constexpr Real length = 4, height = 0.8, waist = 0.7; // mm
constexpr Real middle = 2.07;                         // mm, where it is narrow: on no node or cell centre of any level
constexpr Real radius = 0.4;                          // mm
constexpr Real strength = 0.5;                        // MPa, strains of 0.05 and 0.1 %
constexpr Real energy = 0.001; // N/mm: the bar is shorter than the critical length, so it tears without waves, which
                               // would break it again in shear

enum class Pull
{
    tension,
    shear,
};

/// A bar along x whose height has a shallow minimum, one cell thick, pulled or sheared at its ends.
solver::Problem narrow_bar(Pull pull, Real cell, Real nonlocal_radius)
{
    solver::Problem problem;
    problem.title = "narrow bar";
    problem.grid.cell = cell;
    material::Material m;
    m.elastic = {1e-3, 1000, 0};
    m.decohesion = material::Decohesion{};
    const Real infinity = std::numeric_limits<Real>::infinity();
    m.decohesion->s_max = pull == Pull::tension ? strength : infinity;
    m.decohesion->tau_max = pull == Pull::tension ? infinity : strength;
    m.decohesion->energy_1 = m.decohesion->energy_2 = energy;
    m.decohesion->nonlocal_radius = m.decohesion->crack_exclusion = nonlocal_radius;
    problem.materials = {m};
    const Real depth = (height - waist) / 2;
    const geometry::Shape outline = geometry::extruded_polygon(
        {{0, 0}, {middle, depth}, {length, 0}, {length, height}, {middle, height - depth}, {0, height}}, 2, 0, cell);
    problem.bodies = {{"bar", outline, 0, {0, 0, 0}}};
    problem.numerics = support::nodal_numerics(solver::Precision::f64);
    problem.end.separated = false;
    const Real speed = pull == Pull::tension ? 0.005 : 0.01, ramp_time = 0.06; // quasi-static
    const auto end_velocity = [&](Real v) {
        return pull == Pull::tension ? std::array<std::optional<Real>, 3>{v, 0.0, 0.0}
                                     : std::array<std::optional<Real>, 3>{0.0, v, 0.0};
    };
    problem.loads = {support::load("left", support::beyond(0, 0.41, -1), end_velocity(-speed), ramp_time),
                     support::load("right", support::beyond(0, 3.59, 1), end_velocity(speed), ramp_time)};
    if (pull == Pull::shear) // no bending: the rest moves along y only
        problem.loads.push_back(
            support::load("between", geometry::box({0.42, -1, -1}, {3.58, 2, 2}), {0.0, {}, 0.0}, ramp_time));
    return problem;
}

/// What became of the bar.
struct Break
{
    Real strength = 0;      // MPa, mean stress in the waist when the first particle starts
    Real dissipated = 0;    // N/mm, per area of the waist
    Real area = 0;          // 1, rest volume separated over cell size, over the area of the waist
    std::size_t layers = 0; // most cells separated one behind the other along x
};

bool all_separated(const std::vector<core::Crack>& cracks)
{
    return !cracks.empty() &&
           std::all_of(cracks.begin(), cracks.end(), [](const core::Crack& crack) { return crack.damage >= 1; });
}

Break broken(Pull pull, Real cell, Real nonlocal_radius)
{
    Job run = support::started(narrow_bar(pull, cell, nonlocal_radius));
    const int axis = pull == Pull::tension ? 0 : 1;
    const Real area = waist * cell;
    Break result;
    // Until it is through: later the faces, smeared over a cell that shears on and turns, catch on each other.
    while (run.state.clock.time < 0.8 && !all_separated(run.state.particles.cracks)) {
        support::advance(1, run);
        if (result.strength == 0 && !run.state.particles.cracks.empty())
            result.strength = std::abs(run.state.loads[1].reaction[axis]) / area;
    }
    result.dissipated = solver::audit(run.prepared, run.state).decohesion / area;
    std::map<int, std::set<int>> separated; // [row along x] cells
    const particles::Particles& particles = run.state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const auto index = [&](std::size_t a) { return static_cast<int>(particles.rest_position[a][p] / cell); };
        if (particles.crack[p] < 0 || particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage < 1)
            continue;
        separated[index(1)].insert(index(0));
        result.area += particles.rest_volume[p] / cell / area;
    }
    for (const auto& [row, cells] : separated) result.layers = std::max(result.layers, cells.size());
    return result;
}

class NonlocalCrack : public testing::TestWithParam<Pull>
{};
} // namespace

TEST_P(NonlocalCrack, is_one_layer_and_dissipates_the_fracture_energy_at_any_cell_size)
{
    Real coarse_strength = 0;
    for (const Real cell : {0.4, 0.2, 0.1}) {
        SCOPED_TRACE(testing::Message() << "cells of " << cell << " mm");
        const Break result = broken(GetParam(), cell, radius);
        EXPECT_EQ(result.layers, 1U);
        EXPECT_NEAR(result.area, 1, 0.05);
        EXPECT_NEAR(result.dissipated / energy, 1, 0.05);
        if (coarse_strength == 0) coarse_strength = result.strength;
        EXPECT_NEAR(result.strength / coarse_strength, 1, 0.01);
    }
}

INSTANTIATE_TEST_SUITE_P(Pulls, NonlocalCrack, testing::Values(Pull::tension, Pull::shear));
