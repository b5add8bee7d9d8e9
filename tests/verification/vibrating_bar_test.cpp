// Vibrating bar (methods.md C5): L = 25, E = 100, rho = 1, fixed at x = 0, v(x, 0) = v_0 sin(pi x / 2L); period 10.
// The amplitude is small, so the linear solution holds. Second order in the period, on one level and across an
// interface in the middle.
#include "tests/support/bars.h"

#include <gtest/gtest.h>

#include <numbers>

namespace
{
struct Scheme
{
    const char* name;
    solver::Formulation formulation;
    solver::Transfer transfer;
    solver::StressUpdate stress_update;
    bool refined;
    Real largest_error; // of the period, relative, on 32 cells
    solver::Precision precision = solver::Precision::f64;
    solver::Basis basis = solver::Basis::trilinear;
};

constexpr Real length = 25, period = 10, beta = std::numbers::pi / (2 * length);

/// Relative error of the mean period over two vibrations.
Real period_error(const Scheme& scheme, int cells)
{
    solver::Problem problem =
        support::thin_bar(length, cells, 100, 1, scheme.refined ? std::optional<Real>(length / 2) : std::nullopt);
    problem.symmetry = {{0, 0}};
    problem.numerics.formulation = scheme.formulation;
    problem.numerics.transfer = scheme.transfer;
    problem.numerics.stress_update = scheme.stress_update;
    problem.numerics.precision = scheme.precision;
    problem.numerics.basis = scheme.basis;
    support::Job run = support::started(problem);
    const Real speed = 1e-4;
    support::set_wave([&](Real x) { return speed * std::sin(beta * x); },
                      [&](Real x) { return speed * beta * std::cos(beta * x); }, [](Real) { return 0; }, run);
    const auto amplitude = [&] {
        const solver::OutputColumns columns(run.state);
        const particles::Particles& particles = run.state.particles;
        Real sum = 0;
        for (std::size_t p = 0; p < particles.size(); ++p)
            sum += particles.mass[p] * particles.velocity[0][p] * std::sin(beta * particles.rest_position[0][p]);
        return sum;
    };
    std::vector<Real> crossings;
    Real before = amplitude();
    while (crossings.size() < 5 && run.state.clock.time < 3 * period) {
        support::advance(1, run);
        const Real now = amplitude();
        if (before * now < 0) crossings.push_back(run.state.clock.time - run.state.clock.dt * now / (now - before));
        before = now;
    }
    EXPECT_EQ(crossings.size(), 5U);
    return std::abs((crossings.back() - crossings.front()) / 2 / period - 1);
}
} // namespace

TEST(VibratingBar, period_converges_with_second_order)
{
    using enum solver::Formulation;
    using enum solver::Transfer;
    using enum solver::StressUpdate;
    constexpr auto f64 = solver::Precision::f64;
    constexpr auto gimp = solver::Basis::gimp;
    constexpr Scheme schemes[] = {
        {"total flip", total, flip, usl, false, 5e-4},
        {"total apic", total, apic, usl, false, 1.5e-4},
        {"total flip musl", total, flip, musl, false, 5e-4},
        {"updated flip", updated, flip, usl, false, 5e-4},
        {"updated apic", updated, apic, usl, false, 1.5e-4},
        {"total flip, two levels", total, flip, usl, true, 5e-4},
        {"total apic, two levels", total, apic, usl, true, 1.5e-4},
        {"updated flip, two levels", updated, flip, usl, true, 5e-4},
        {"updated gimp flip", updated, flip, musl, false, 5e-4, f64, gimp},
        {"updated gimp apic", updated, apic, usl, false, 1.5e-4, f64, gimp},
        {"updated gimp flip, two levels", updated, flip, musl, true, 5e-4, f64, gimp},
        {"nodal", total, nodal, usl, false, 1.5e-4},
        {"nodal mixed", total, nodal, usl, false, 1.5e-4, solver::Precision::mixed},
        {"nodal, two levels", total, nodal, usl, true, 1.5e-4},
        {"nodal mixed, two levels", total, nodal, usl, true, 1.5e-4, solver::Precision::mixed},
    };
    for (const Scheme& scheme : schemes) {
        const Real coarse = period_error(scheme, 8), middle = period_error(scheme, 16), fine = period_error(scheme, 32);
        EXPECT_LT(fine, scheme.largest_error) << scheme.name;
        EXPECT_GT(coarse / middle, 3.4) << scheme.name << ' ' << coarse << ' ' << middle;
        EXPECT_GT(middle / fine, 3.6) << scheme.name << ' ' << middle << ' ' << fine;
    }
}
