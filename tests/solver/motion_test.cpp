// Motions in closed form against their own derivatives: velocity and rate by differences in time, F by differences in
// space, and the body force from acceleration and div P, P = J sigma F^-T. The stress against an integration of the
// program's law along the path.
#include "solver/motion.h"

#include "solver/point.h"
#include "tests/support/runs.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace
{
using solver::Mat3;

struct Sample
{
    const char* name;
    solver::Motion motion;
    Vec3 place;
    bool forced; // has a body force, and a stress of finite amplitude
};

std::vector<Sample> samples()
{
    const material::Elastic steel{2, 800, 0.3}, cork{2, 800, 0};
    solver::StandingWave shear{0, 1, solver::WaveKind::shear, 3, 0.1, 0.4, 1e-6};
    solver::StandingWave plane{1, 1, solver::WaveKind::plane, 3, 0.1, 0.4, 1e-6};
    return {
        {"spin", {"", steel, solver::Spin{{0.1, 0.2, 0.3}, 1, 2.5, {1, 2, 3}}}, {0.7, 0.9, -0.4}, true},
        {"shear", {"", steel, shear}, {0.7, 0.9, -0.4}, false},
        {"plane", {"", steel, plane}, {0.7, 0.9, -0.4}, false},
        {"packet", {"", steel, solver::Packet{2, 2, solver::WaveKind::bar, 3, 2, 0.1, 1e-6}}, {0.7, 0.9, -0.4}, false},
        {"box", {"", steel, solver::BoxWave{{0.1, 0, 0}, 1.5, 0.1, 2}}, {0.7, 0.9, 0.4}, true},
        {"vortex", {"", steel, solver::Vortex{{0.1, 0, 0}, 0, 0.75, 1.25, 0.8, 2}}, {0.7, 0.7, 0.6}, true},
        {"ring", {"", cork, solver::Ring{{0.1, 0, 0}, 2, 0.4, 0.6, 0.05}}, {0.45, 0.3, 0.6}, true},
    };
}

constexpr Real instant = 0.037, small = 1e-5;

Mat3 piola(const solver::MotionState& s)
{
    Mat3 stress;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) stress(i, j) = s.stress(i, j);
    return s.deformation.determinant() * stress * s.deformation.inverse().transpose();
}
} // namespace

TEST(Motion, derivatives_are_those_of_the_displacement)
{
    for (const Sample& sample : samples()) {
        SCOPED_TRACE(sample.name);
        const auto state = [&](const Vec3& x, Real t) { return at(sample.motion, x, t); };
        const solver::MotionState now = state(sample.place, instant);
        const solver::MotionState before = state(sample.place, instant - small),
                                  after = state(sample.place, instant + small);
        const Real speed = now.velocity.norm();
        EXPECT_LT(((after.displacement - before.displacement) / (2 * small) - now.velocity).norm(), 1e-5 * speed);
        const Mat3 rate = (after.deformation - before.deformation) / (2 * small);
        Mat3 gradient = Mat3::Identity();
        for (int a = 0; a < 3; ++a) {
            const Vec3 step = small * Vec3::Unit(a);
            gradient.col(a) +=
                (state(sample.place + step, instant).displacement - state(sample.place - step, instant).displacement) /
                (2 * small);
        }
        // A bar wave contracts sideways without moving sideways: only its axis is compared.
        if (const auto* packet = std::get_if<solver::Packet>(&sample.motion.kind)) {
            const int axis = packet->axis;
            EXPECT_NEAR(now.deformation(axis, axis), gradient(axis, axis), 1e-12);
            EXPECT_NEAR(rate(axis, axis), now.rate(axis, axis), 1e-4 * now.rate.norm());
        } else {
            EXPECT_LT((gradient - now.deformation).norm(), 1e-8);
            EXPECT_LT((rate - now.rate).norm(), 1e-4 * now.rate.norm());
        }
    }
}

TEST(Motion, body_force_is_acceleration_minus_divergence_of_stress)
{
    for (const Sample& sample : samples()) {
        SCOPED_TRACE(sample.name);
        const auto state = [&](const Vec3& x, Real t) { return at(sample.motion, x, t); };
        const Vec3 acceleration =
            (state(sample.place, instant + small).velocity - state(sample.place, instant - small).velocity) /
            (2 * small);
        Vec3 divergence = Vec3::Zero();
        for (int a = 0; a < 3; ++a) {
            const Vec3 step = small * Vec3::Unit(a);
            divergence +=
                (piola(state(sample.place + step, instant)) - piola(state(sample.place - step, instant))).col(a) /
                (2 * small);
        }
        const Vec3 wanted = acceleration - divergence / sample.motion.elastic.density;
        const Real size = acceleration.norm() + divergence.norm() / sample.motion.elastic.density;
        EXPECT_LT((wanted - state(sample.place, instant).body_force).norm(), (sample.forced ? 1e-6 : 1e-5) * size);
    }
}

TEST(Motion, stress_is_that_of_the_law_along_the_path)
{
    for (const Sample& sample : samples()) {
        if (!sample.forced) continue;
        SCOPED_TRACE(sample.name);
        material::Material metal;
        metal.elastic = sample.motion.elastic;
        const solver::PointLaw law = solver::point_law(metal, 1);
        // Paths through zero displacement begin there; the box wave's stress is that of its stretch alone.
        const bool box = std::holds_alternative<solver::BoxWave>(sample.motion.kind);
        solver::PointState point;
        constexpr int steps = 4000;
        Mat3 f = Mat3::Identity();
        for (int n = 1; n <= steps; ++n) {
            const Real share = n / Real(steps);
            const Mat3 end = at(sample.motion, sample.place, instant).deformation;
            const Mat3 next = box ? Mat3(Mat3::Identity() + share * (end - Mat3::Identity()))
                                  : at(sample.motion, sample.place, share * instant).deformation;
            const Mat3 g = (next - f) * ((next + f) / 2).inverse();
            solver::PointStep step;
            step.strain = {
                {g(0, 0), g(1, 1), g(2, 2), (g(0, 1) + g(1, 0)) / 2, (g(1, 2) + g(2, 1)) / 2, (g(0, 2) + g(2, 0)) / 2}};
            step.rotation = {{(g(2, 1) - g(1, 2)) / 2, (g(0, 2) - g(2, 0)) / 2, (g(1, 0) - g(0, 1)) / 2}};
            step.dt = instant / steps;
            point = solver::advance(law, point, step);
            f = next;
        }
        const solver::MotionState exact = at(sample.motion, sample.place, instant);
        for (std::size_t c = 0; c < 6; ++c)
            EXPECT_NEAR(point.stress.s[c], exact.stress.s[c], 1e-4 * metal.elastic.youngs_modulus * 0.1) << c;
    }
}
