// Uniaxial tension of a column of cells, free to contract, against the exact curve of J2 plasticity with linear
// hardening in logarithmic strain e = ln(l / L):
//
//   s = E e,  beyond yield s = s_y + E_T (e - s_y / E);   e_p = e - s / E;   A = A_0 exp(-2 nu s / E - e_p);   F = s A.
#include "solver/observe.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

namespace
{
constexpr Real youngs = 1000, poisson = 0.3, yield = 5, tangent = 100;

Real exact_force(Real stretch)
{
    const Real e = std::log(stretch);
    const Real s = youngs * e < yield ? youngs * e : yield + tangent * (e - yield / youngs);
    return s * std::exp(-2 * poisson * s / youngs - (e - s / youngs));
}

struct Scheme
{
    const char* name;
    solver::Transfer transfer;
    solver::StressUpdate stress_update;
    solver::Precision precision = solver::Precision::f64;
};

void follow_the_curve(const Scheme& scheme)
{
    SCOPED_TRACE(scheme.name);
    material::Material metal;
    metal.elastic = {1e-3, youngs, poisson};
    metal.plastic = material::VonMises{yield, tangent};
    const Real length = 4, speed = 0.1;
    solver::Problem problem = support::bar(metal, speed, 0.5);
    problem.grid.cell = 1;
    problem.bodies[0].shape = geometry::box({0, 0, 0}, {1, length, 1});
    problem.symmetry = {{0, 0}, {1, 0}, {2, 0}};
    problem.loads = {support::load("top", support::beyond(1, length, 1), {std::nullopt, speed, std::nullopt}, 0.5)};
    problem.numerics.transfer = scheme.transfer;
    problem.numerics.stress_update = scheme.stress_update;
    problem.numerics.precision = scheme.precision;
    support::Job run = support::started(problem);
    while (run.state.clock.time < 3) {
        const Real before = run.state.loads[0].displacement[1];
        support::advance(40, run); // one vibration of the column
        const Real middle = (before + run.state.loads[0].displacement[1]) / 2;
        const Real force =
            solver::observe(run.problem, run.prepared, run.derived, run.state).force_upper / 4; // two planes
        const Real exact = exact_force(1 + middle / length);
        if (middle / length < 0.5 * yield / youngs) continue; // a small force rings by a larger share
        EXPECT_NEAR(force / exact, 1, 0.005) << run.state.clock.time << " ms";
    }
    EXPECT_GT(run.state.loads[0].displacement[1] / length, 0.04);
}
} // namespace

TEST(Tension, follows_the_exact_curve_through_yield)
{
    using enum solver::Transfer;
    using enum solver::StressUpdate;
    for (const Scheme& scheme : {Scheme{"flip", flip, usl}, Scheme{"flip musl", flip, musl}, Scheme{"apic", apic, usl},
                                 Scheme{"apic musl", apic, musl}, Scheme{"nodal", nodal, usl},
                                 Scheme{"nodal mixed", nodal, usl, solver::Precision::mixed}})
        follow_the_curve(scheme);
}
