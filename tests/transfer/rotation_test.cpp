// Stress under rigid rotation (methods.md B20): objective, and of constant size.
#include "tests/support/scene.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numbers>

using support::Scene;
using transfer::Formulation;

namespace
{
/// Rotate a block with random stress by a full turn about (1, 2, 3) in `steps` steps; largest relative change of |s|
/// and the final error of s itself.
std::pair<Real, Real> turned(Formulation formulation, int steps)
{
    transfer::PassOptions options;
    options.formulation = formulation;
    options.dt = 1;
    Scene scene =
        support::scene_of(support::topologies()[4], options, {support::soft_elastic()}, support::Layout::regular);
    support::randomise_state(9, scene);
    const Vec3 axis = Vec3(1, 2, 3).normalized();
    const Real angle = 2 * std::numbers::pi / steps;
    const Eigen::Matrix3d chord = Eigen::AngleAxisd(angle, axis).toRotationMatrix() - Eigen::Matrix3d::Identity();
    const particles::Particles before = scene.particles;
    Real size_change = 0, error = 0;
    for (int n = 0; n < steps; ++n) {
        // Total: nodes move along the chord of the turn, at rest positions. Updated: the spin itself strains nothing.
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(n * angle, axis).toRotationMatrix();
        support::prescribe_motion(
            [&](const Vec3& x) -> Vec3 {
                return formulation == Formulation::total ? Vec3(chord * turn * x) : Vec3(angle * axis.cross(x));
            },
            scene.levels);
        transfer::advance_and_scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels,
                                      scene.leaf_work);
        if (formulation == Formulation::total) continue;
        // The block stays where it is: only the stress turns.
        scene.particles.position = before.position;
        std::fill(scene.particles.away.begin(), scene.particles.away.end(), std::uint8_t(0));
        scene.particles.volume_ratio = before.volume_ratio;
        support::order(scene);
    }
    for (std::size_t p = 0; p < before.size(); ++p) {
        const Eigen::Matrix3d old = support::stress_of(before, p), now = support::stress_of(scene.particles, p);
        size_change = std::max(size_change, std::abs(now.norm() / old.norm() - 1));
        error = std::max(error, (now - old).norm() / old.norm());
    }
    return {size_change, error};
}
} // namespace

TEST(Rotation, a_full_turn_keeps_the_size_of_the_stress_and_brings_it_back)
{
    for (const Formulation formulation : {Formulation::updated, Formulation::total}) {
        const auto [coarse_size, coarse_error] = turned(formulation, 36);
        const auto [fine_size, fine_error] = turned(formulation, 72);
        EXPECT_LT(coarse_size, 1e-9);
        EXPECT_LT(fine_size, 1e-9);
        // Phase error O(angle^2) of a full turn; the total formulation knows the chord, so it makes none.
        EXPECT_LT(coarse_error, 0.05);
        if (formulation == Formulation::updated) {
            EXPECT_NEAR(coarse_error / fine_error, 4, 0.2);
        } else {
            EXPECT_LT(fine_error, 1e-9);
        }
    }
}
