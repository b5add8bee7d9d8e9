/// material/rotation.h: exact orthogonality, norms (scene B20), the Jaumann curve in simple shear (B19), lanes.
#include "material/elastic.h"
#include "tests/material/samples.h"

#include <gtest/gtest.h>

#include <numbers>

namespace material
{
TEST(Rotation, is_orthogonal_and_proper)
{
    Samples samples;
    for (int k = 0; k < 100; ++k) {
        const Mat r = samples.rotation();
        const Mat product = r * transposed(r);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(product(i, j), i == j ? 1 : 0, 1e-14);
        EXPECT_NEAR(core::determinant(r), 1, 1e-14);
    }
}

TEST(Rotation, is_the_cayley_map_of_the_spin)
{
    Samples samples;
    const Mat gradient = samples.matrix(0.3);
    const Vec a = spin_increment(gradient);
    const Mat r = incremental_rotation(a);
    // (I - w/2) R x = (I + w/2) x
    const Vec x = samples.vector(1);
    const Vec rx = r * x;
    const Vec left = rx - 0.5 * core::cross(a, rx), right = x + 0.5 * core::cross(a, x);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(left[i], right[i], 1e-15);
    // The axial vector is that of the skew part.
    for (int i = 0; i < 3; ++i) {
        const Vec skew = 0.5 * (gradient * x - transposed(gradient) * x);
        EXPECT_NEAR(core::cross(a, x)[i], skew[i], 1e-15);
    }
}

TEST(Rotation, turns_by_the_spin_to_second_order)
{
    const double angle = 1e-2;
    const Mat r = incremental_rotation<double>({{0, 0, angle}});
    EXPECT_NEAR(std::atan2(r(1, 0), r(0, 0)), angle, 1.01 * std::pow(angle, 3) / 12);
}

/// B20: a full turn in N steps changes no invariant; the phase error falls with N^2.
TEST(Rotation, keeps_the_norm_of_a_stress_through_a_full_turn)
{
    const Sym start{{300, -100, 50, 120, -60, 30}};
    double last_phase_error = 0;
    for (const int steps : {36, 360, 3600}) {
        const Mat r = incremental_rotation<double>({{0, 0, 2 * std::numbers::pi / steps}});
        Sym stress = start;
        for (int i = 0; i < steps; ++i) stress = core::rotated(r, stress);
        EXPECT_NEAR(norm(stress) / norm(start), 1, 1e-12) << steps;
        EXPECT_NEAR(core::trace(stress), core::trace(start), 1e-9) << steps;
        const double phase_error = norm(stress - start) / norm(start);
        if (last_phase_error > 0) {
            EXPECT_NEAR(last_phase_error / phase_error, 100, 5);
        }
        last_phase_error = phase_error;
    }
}

/// B21: a square is stretched, sheared, unstretched and unsheared (Kojic & Bathe 1987). A rate form with the Jaumann
/// rate does not come back to zero stress: what is left grows with the third power of the strains.
TEST(Rotation, leaves_a_little_stress_after_a_closed_cycle)
{
    const Elastic elastic = steel();
    const auto lame = lame_constants<double>(elastic);
    const auto left = [&](double size) {
        Sym stress{};
        const int steps = 4000;
        const double d = size / steps;
        const auto advance = [&](const Mat& gradient) {
            const Vec spin = spin_increment(gradient);
            const Sym strain = at_end_of_step(core::symmetric_part(gradient), spin);
            stress = elastic_trial(core::rotated(incremental_rotation(spin), stress), strain, lame);
        };
        const auto stretch = [](double rate) { return Mat{{0, 0, 0, 0, rate, 0, 0, 0, 0}}; };
        const auto shear = [](double rate) { return Mat{{0, rate, 0, 0, 0, 0, 0, 0, 0}}; };
        for (int i = 0; i < steps; ++i) advance(stretch(d / (1 + (i + 0.5) * d)));
        for (int i = 0; i < steps; ++i) advance(shear(d / (1 + size)));
        for (int i = 0; i < steps; ++i) advance(stretch(-d / (1 + size - (i + 0.5) * d)));
        for (int i = 0; i < steps; ++i) advance(shear(-d));
        return norm(stress) / elastic.shear_modulus();
    };
    const double large = left(0.1), small = left(0.05);
    EXPECT_NEAR(large, 9e-4, 1e-4);
    EXPECT_NEAR(large / small, 8, 0.6);
}

/// B19: elastic simple shear under the Jaumann rate, sigma_12 = mu sin gamma, sigma_11 = mu (1 - cos gamma).
TEST(Rotation, gives_the_jaumann_stress_of_simple_shear)
{
    const Elastic elastic = steel();
    const auto lame = lame_constants<double>(elastic);
    const double mu = elastic.shear_modulus();
    const int steps = 20000;
    const double dg = 10.0 / steps;
    Mat gradient{};
    gradient(0, 1) = dg;
    const Mat half_turn = incremental_rotation(spin_increment(Mat{{0, dg / 2, 0, 0, 0, 0, 0, 0, 0}}));
    Sym stress{};
    for (int i = 1; i <= steps; ++i) {
        // Rate at mid-step: half of the turn before the strain, half after it.
        stress = core::rotated(half_turn,
                               elastic_trial(core::rotated(half_turn, stress), core::symmetric_part(gradient), lame));
        if (i % 1000 != 0) continue;
        const double gamma = i * dg;
        EXPECT_NEAR(stress[3] / mu, std::sin(gamma), 1e-6);
        EXPECT_NEAR(stress[0] / mu, 1 - std::cos(gamma), 1e-6);
        EXPECT_NEAR(stress[1], -stress[0], 1e-9 * mu);
    }
}

/// A body that stretches at a steady rate while it turns by a radian: stress in its own axes is 2 mu e + lambda tr e.
/// With the strain of mid-step added in the axes of the end it is of second order, else of first.
TEST(Rotation, stress_of_a_turning_stretch_is_of_second_order)
{
    const auto lame = lame_constants<double>(steel());
    const Sym own{{3e-4, -1e-4, 0, 2e-4, 1e-4, -2e-4}};
    const core::Vec<double> axis{{0.48, -0.6, 0.64}};
    const auto about = [&](double angle) { // exact turn
        const double a = 2 * std::tan(angle / 2);
        return incremental_rotation<double>({{a * axis[0], a * axis[1], a * axis[2]}});
    };
    double last = 0;
    for (const int steps : {10, 20, 40}) {
        Sym stress{};
        const double a = 2 * std::tan(0.5 / steps);
        const core::Vec<double> spin{{a * axis[0], a * axis[1], a * axis[2]}};
        for (int i = 0; i < steps; ++i) {
            const Sym middle = core::rotated(about((i + 0.5) / steps), (1.0 / steps) * own);
            stress =
                elastic_trial(core::rotated(incremental_rotation(spin), stress), at_end_of_step(middle, spin), lame);
        }
        const Sym exact = core::rotated(about(1), elastic_trial(Sym{}, own, lame));
        double error = 0;
        for (int n = 0; n < 6; ++n) error = std::max(error, std::abs(stress[n] - exact[n]) / 100);
        EXPECT_LT(error, 0.2 / (steps * steps));
        if (last > 0) {
            EXPECT_NEAR(last / error, 4, 0.1);
        }
        last = error;
    }
}

TEST(Rotation, lanes_agree_with_scalar)
{
    using Lanes = core::Pack<double, core::native_lanes<double>>;
    Samples samples;
    core::Mat<Lanes> gradient{};
    core::Sym<Lanes> stress{};
    std::array<Mat, Lanes::lanes> gradients;
    std::array<Sym, Lanes::lanes> stresses;
    for (int lane = 0; lane < Lanes::lanes; ++lane) {
        const auto l = static_cast<std::size_t>(lane);
        gradients[l] = samples.matrix(0.1);
        stresses[l] = samples.tensor(1);
        for (std::size_t i = 0; i < 9; ++i) gradient.m[i].v[lane] = gradients[l].m[i];
        for (std::size_t i = 0; i < 6; ++i) stress.s[i].v[lane] = stresses[l].s[i];
    }
    const auto turned = core::rotated(incremental_rotation(spin_increment(gradient)), stress);
    for (int lane = 0; lane < Lanes::lanes; ++lane) {
        const auto l = static_cast<std::size_t>(lane);
        const Sym expected = core::rotated(incremental_rotation(spin_increment(gradients[l])), stresses[l]);
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(turned[i][lane], expected[i], 1e-15);
    }
}
} // namespace material
