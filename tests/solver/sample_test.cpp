// Measures of a case: values on fields that are known, and how many values become one.
#include "solver/sample.h"

#include "solver/quantity_values.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using support::Job;

namespace
{
using Field = solver::FieldComponent::Field;
using Component = solver::FieldComponent::Component;

/// A bar whose particles have been moved by a linear field (and stress and velocity with it), total formulation.
Job moved_bar()
{
    solver::Problem problem = support::bar(support::metal(), 0, 0);
    problem.numerics = support::numerics(solver::Formulation::total);
    Job run = support::started(problem);
    particles::Particles& particles = run.state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Real x = particles.rest_position[0][p], y = particles.rest_position[1][p];
        particles.position[0][p] = x + 0.1 * x + 0.2 * y;
        particles.deformation_gradient[0][p] = 1.1;
        particles.deformation_gradient[1][p] = 0.2;
        particles.velocity[1][p] = 3 + x;
        particles.stress[0][p] = 10 * y;
        particles.stress[1][p] = 2;
    }
    return run;
}

solver::Quantity quantity(const char* name, const decltype(solver::Quantity::kind)& kind)
{
    solver::Quantity q;
    q.name = name;
    q.kind = kind;
    return q;
}

solver::ParticleView view(const Job& run)
{
    return {run.state.particles, run.state.levels, run.prepared.per_axis};
}

/// Samples of one measure, a value at every time.
template <class Value>
std::vector<solver::Sample> series(int count, Real step, const Value& value)
{
    std::vector<solver::Sample> samples;
    for (int n = 0; n <= count; ++n) samples.push_back({n, n * step, {value(n * step), n * step}});
    return samples;
}

Real reduced(solver::Reduction::At at, const std::vector<solver::Sample>& samples, solver::Reduction reduction = {})
{
    std::vector<solver::Quantity> quantities{quantity("a", solver::Energy{}), quantity("b", solver::Energy{})};
    quantities[0].reduction = reduction;
    quantities[0].reduction.at = at;
    return solver::results(quantities, samples)[0];
}
} // namespace

TEST(Measures, a_probe_at_a_point_is_exact_for_linear_fields_also_on_the_surface)
{
    const Job run = moved_bar();
    for (const Vec3& point : {Vec3(2, 4, 1), Vec3(0, 0, 0.5), Vec3(1, 1.3, 0.5)}) {
        solver::Probe probe{{Field::displacement, Component::x}, point, {}, {}, {}};
        EXPECT_NEAR(value_of(probe, view(run)), 0.1 * point[0] + 0.2 * point[1], 1e-12);
        probe.field = {Field::stress, Component::xx};
        EXPECT_NEAR(value_of(probe, view(run)), 10 * point[1], 1e-10);
    }
    const solver::Difference difference{{Field::displacement, Component::x}, {2, 3, 0}, {1, 1, 0}, {}};
    EXPECT_NEAR(value_of(difference, view(run)), 0.1 + 0.4, 1e-12);
}

TEST(Measures, regions_extents_volume_and_momentum)
{
    const Job run = moved_bar();
    const geometry::Shape top = support::beyond(1, 3, 1);
    solver::Probe probe{{Field::stress, Component::xx}, {}, {}, top, solver::Probe::Over::mean};
    EXPECT_NEAR(value_of(probe, view(run)), 35, 1e-10);
    probe.over = solver::Probe::Over::max;
    EXPECT_NEAR(value_of(probe, view(run)), 10 * 3.875, 1e-10);
    probe.over = solver::Probe::Over::min;
    EXPECT_NEAR(value_of(probe, view(run)), 10 * 3.125, 1e-10);
    EXPECT_NEAR(value_of(solver::Volume{top}, view(run)), 2 * 1.1, 1e-10);
    EXPECT_NEAR(value_of(solver::Momentum{false, 1, {}}, view(run)), 8e-3 * 4, 1e-12);
    EXPECT_NEAR(value_of(solver::Extent{{}, {}, 1, solver::Extent::What::length, {}}, view(run)), 4, 1e-12);
    EXPECT_NEAR(value_of(solver::Extent{{}, {}, 1, solver::Extent::What::upper, {}}, view(run)), 4, 1e-12);
    const solver::Probe empty{{Field::von_mises, {}}, {}, {}, support::beyond(1, 30, 1), {}};
    EXPECT_TRUE(std::isnan(value_of(empty, view(run))));
}

TEST(Measures, polar_components)
{
    Job run = moved_bar();
    const particles::Particles& particles = run.state.particles;
    const std::size_t p = 5;
    const Vec3 x(particles.position[0][p], particles.position[1][p], 0);
    const Real c = x[0] / x.norm(), s = x[1] / x.norm(), xx = particles.stress[0][p], yy = 2;
    const auto value = [&](Field field, Component component) {
        return solver::field_value({field, component, Vec3::Zero(), 2}, particles, p);
    };
    EXPECT_NEAR(value(Field::stress, Component::radial), c * c * xx + s * s * yy, 1e-10);
    EXPECT_NEAR(value(Field::stress, Component::around), s * s * xx + c * c * yy, 1e-10);
    EXPECT_NEAR(value(Field::stress, Component::radial_around), c * s * (yy - xx), 1e-10);
    EXPECT_NEAR(value(Field::velocity, Component::radial), s * particles.velocity[1][p], 1e-10);
    EXPECT_NEAR(value(Field::velocity, Component::around), c * particles.velocity[1][p], 1e-10);
}

TEST(Measures, many_values_become_one)
{
    using enum solver::Reduction::At;
    const Real omega = 2 * std::numbers::pi / 3;
    const auto wave = series(1200, 0.01, [&](Real t) { return 5 + 2 * std::sin(omega * t); });
    EXPECT_NEAR(reduced(period, wave), 3, 1e-4);
    EXPECT_NEAR(reduced(amplitude, wave), 2, 1e-4);
    EXPECT_NEAR(reduced(mean, wave), 5, 1e-3);
    EXPECT_NEAR(reduced(max, wave), 7, 1e-4);
    EXPECT_NEAR(reduced(min, wave), 3, 1e-4);
    EXPECT_NEAR(reduced(end, wave), 5, 1e-9);
    solver::Reduction some;
    some.frequency = 1.0 / 3;
    EXPECT_NEAR(reduced(fourier, wave, some), 2, 1e-3);
    some.time = 0.755;
    EXPECT_NEAR(reduced(end, wave, some), 5 + 2 * std::sin(omega * 0.755), 1e-3);
    solver::Reduction window;
    window.from = 2;
    window.until = 3;
    EXPECT_LT(reduced(max, wave, window), 5 + 1e-9);
    solver::Reduction when;
    when.of = 0; // the second measure is the time
    std::vector<solver::Quantity> quantities{quantity("a", solver::Energy{}), quantity("t", solver::Energy{}),
                                             quantity("r", solver::Ratio{1, 0})};
    quantities[1].reduction.at = when_max;
    quantities[1].reduction.until = 2.5;
    auto with_ratio = wave;
    for (solver::Sample& sample : with_ratio) sample.value.push_back(0);
    const std::vector<Real> results = solver::results(quantities, with_ratio);
    EXPECT_NEAR(results[1], 0.75, 0.01);
    EXPECT_NEAR(results[2], results[1] / results[0], 1e-12);
    EXPECT_TRUE(std::isnan(reduced(period, series(10, 0.1, [](Real t) { return t; }))));
}

// A falling value with a negative scale is a result that rises: its largest is meant, not that of the value.
TEST(Measures, when_max_is_when_the_scaled_result_was_largest)
{
    using enum solver::Reduction::At;
    const auto wave = series(300, 0.01, [](Real t) { return std::sin(2 * std::numbers::pi / 3 * t); });
    std::vector<solver::Quantity> quantities{quantity("a", solver::Energy{}), quantity("t", solver::Energy{})};
    const auto time = [&](Real scale, solver::Reduction::At at) {
        quantities[0].scale = scale;
        quantities[1].reduction.at = at;
        return solver::results(quantities, wave)[1];
    };
    for (const bool falls : {false, true}) {
        quantities[0].reduction.at = falls ? min : max;
        quantities[0].scale = falls ? -2 : 2;
        EXPECT_NEAR(std::abs(solver::results(quantities, wave)[0]), 2, 1e-9);
        EXPECT_EQ(solver::results(quantities, wave)[0] < 0, falls);
        quantities[0].reduction.at = end;
        EXPECT_NEAR(time(falls ? -2 : 2, when_max), falls ? 2.25 : 0.75, 1e-9);
        EXPECT_NEAR(time(falls ? -2 : 2, when_min), falls ? 0.75 : 2.25, 1e-9);
    }
}

TEST(Measures, a_crack_along_the_second_axis_is_at_90_degrees)
{
    const auto angle = [](Real slope) {
        Job run = moved_bar();
        particles::Particles& particles = run.state.particles;
        particles.cracks.resize(1);
        particles.cracks[0].damage = 1;
        for (std::size_t p = 0; p < 4; ++p) {
            const Real y = static_cast<Real>(p);
            particles.rest_position[0][p] = 1 + slope * y;
            particles.rest_position[1][p] = y;
            particles.crack[p] = 0;
        }
        solver::CrackQuantity line;
        line.what = solver::CrackQuantity::What::angle;
        return value_of(line, run.problem.materials, particles);
    };
    for (const Real rounding : {0.0, 1e-11, -1e-11}) EXPECT_NEAR(angle(rounding), 90, 1e-8);
    for (const Real slope : {0.1, -0.1}) EXPECT_NEAR(angle(slope), std::atan(1 / slope) * 180 / std::numbers::pi, 1e-8);
}

// A mean over no time is no force; 0 would be the least one of every run.
TEST(Measures, a_load_has_no_force_before_the_first_step)
{
    solver::Problem problem = support::bar(support::metal(), 1, 0.01);
    problem.quantities = {quantity("force", solver::LoadQuantity{})};
    problem.quantities[0].reduction.at = solver::Reduction::At::min;
    Job run = support::started(problem);
    const auto sample = [&] { return take_sample(run.problem, run.prepared, run.derived, run.state).value[0]; };
    EXPECT_TRUE(std::isnan(sample()));
    support::advance(1, run);
    const Real force = sample();
    EXPECT_GT(force, 0);
    EXPECT_EQ(solver::results(run.problem.quantities, run.state.samples)[0], force);
}
