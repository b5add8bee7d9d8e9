// A wave that meets finer cells (methods.md A.2). Lumped mass, cells h_1 -> h_2, sin a_k = (h_k / dt) sin(w dt / 2) /
// c:
//
//   R = (cos a_1 - cos a_2) / (cos a_1 + cos a_2),   no free parameter.
//
// The nodal scheme and the affine transfer are the lumped scheme exactly in one dimension. FLIP is not: nodes get their
// velocity from the particles again, which filters it with A = (consistent mass) / (lumped mass) = 1 - 3/4 sin^2 a, and
// with the stress updated last a wave of frequency w decays at the rate (1 - A) dt w^2 / 2; nothing is left of the
// short ones to measure.
#include "tests/support/bars.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace
{
constexpr Real interface_at = 220, probe_at = 160, packet_at = 120; // coarse cells
constexpr Real incident_ends = 110, reflected_ends = 265;           // cells per wave speed

struct Scheme
{
    const char* name;
    solver::Transfer transfer;
    solver::Precision precision;
};
constexpr Scheme schemes[] = {
    {"apic", solver::Transfer::apic, solver::Precision::f64},
    {"nodal", solver::Transfer::nodal, solver::Precision::f64},
    {"nodal mixed", solver::Transfer::nodal, solver::Precision::mixed},
};

struct Spectrum
{
    Real omega;
    std::complex<Real> incident, reflected;
};

/// Reflection measured for wavelengths of so many coarse cells, h = c = 1.
std::vector<Real> measured(const Scheme& scheme, const std::vector<Real>& wavelengths, bool refined)
{
    solver::Problem problem =
        support::thin_bar(290, 290, 1, 1, refined ? std::optional<Real>(interface_at) : std::nullopt);
    problem.numerics.transfer = scheme.transfer;
    problem.numerics.precision = scheme.precision;
    problem.numerics.cfl = refined ? 0.5 : 0.25;
    support::Job run = support::started(problem);

    // A short packet holds all wavelengths at once: v = f(x), sigma = -E v / c runs to the right.
    const Real k = 2 * std::numbers::pi / 8, width = 4, size = 1e-6;
    const auto velocity = [&](Real x) {
        const Real s = x - packet_at;
        return size * std::exp(-s * s / (2 * width * width)) * std::cos(k * s);
    };
    support::set_wave(
        velocity, [&](Real x) { return (velocity(x + 1e-4) - velocity(x - 1e-4)) / 2e-4; },
        [&](Real x) { return -velocity(x); }, run);
    std::size_t probe = 0;
    const auto& rest = run.state.particles.rest_position[0];
    for (std::size_t p = 0; p < rest.size(); ++p)
        if (std::abs(rest[p] - probe_at) < std::abs(rest[probe] - probe_at)) probe = p;

    const Real dt = 0.25;
    std::vector<Spectrum> spectra;
    for (const Real n : wavelengths) spectra.push_back({2 / dt * std::asin(dt * std::sin(std::numbers::pi / n)), 0, 0});
    while (run.state.clock.time < reflected_ends) {
        support::advance(1, run);
        EXPECT_DOUBLE_EQ(run.state.clock.dt, dt);
        const solver::OutputColumns columns(run.state);
        const Real velocity_there = run.state.particles.velocity[0][probe];
        for (Spectrum& s : spectra) {
            const auto term = velocity_there * std::polar(Real(1), -s.omega * run.state.clock.time);
            (run.state.clock.time < incident_ends ? s.incident : s.reflected) += term;
        }
    }
    std::vector<Real> reflection;
    for (const Spectrum& s : spectra) reflection.push_back(std::abs(s.reflected) / std::abs(s.incident));
    return reflection;
}

Real closed_form(Real wavelength)
{
    const Real sine = std::sin(std::numbers::pi / wavelength);
    const Real cosine1 = std::sqrt(1 - sine * sine), cosine2 = std::sqrt(1 - sine * sine / 4);
    return (cosine2 - cosine1) / (cosine2 + cosine1);
}

const std::vector<Real> wavelengths{6, 8, 12};
} // namespace

TEST(WaveReflection, at_an_interface_is_that_of_the_closed_form)
{
    for (const Scheme& scheme : schemes) {
        const std::vector<Real> reflection = measured(scheme, wavelengths, true);
        for (std::size_t i = 0; i < wavelengths.size(); ++i)
            EXPECT_NEAR(reflection[i] / closed_form(wavelengths[i]), 1, 0.03)
                << scheme.name << ", " << wavelengths[i] << " cells";
    }
}

TEST(WaveReflection, vanishes_without_an_interface)
{
    for (const Scheme& scheme : schemes)
        for (const Real reflection : measured(scheme, wavelengths, false)) EXPECT_LT(reflection, 2e-4) << scheme.name;
}
