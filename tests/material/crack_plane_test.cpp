/// material/crack_plane.h: angles of the three modes, choice between conjugate planes, mirrored input (scene B13),
/// equal principal stresses.
#include "material/crack_plane.h"

#include "tests/material/samples.h"

#include <gtest/gtest.h>

#include <numbers>

namespace material
{
namespace
{
double degrees_between(const Vec& a, const Vec& b)
{
    return std::acos(std::min(1.0, std::abs(core::dot(a, b)))) * 180 / std::numbers::pi;
}

Mat shear_along(const Vec& direction, const Vec& normal) // L with L n = direction
{
    Mat l{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) l(i, j) = direction[i] * normal[j];
    return l;
}

Mat turned(const Mat& r, const Mat& l)
{
    return r * l * transposed(r);
}
} // namespace

TEST(CrackPlane, has_the_angle_of_its_mode)
{
    Samples samples;
    for (int k = 0; k < 50; ++k) {
        const Principal p = principal(samples.tensor(100));
        const Bias bias{samples.matrix(1), {}};
        EXPECT_NEAR(degrees_between(crack_normal(Mode::opening, p, bias), p.direction[0]), 0, 1e-5);
        EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, bias), p.direction[0]), 45, 1e-9);
        EXPECT_NEAR(degrees_between(crack_normal(Mode::mixed, p, bias), p.direction[0]), 22.5, 1e-9);
        for (const Mode mode : {Mode::opening, Mode::shear, Mode::mixed}) {
            const Vec n = crack_normal(mode, p, bias);
            EXPECT_NEAR(norm(n), 1, 1e-14);
            EXPECT_NEAR(core::dot(n, p.direction[1]), 0, 1e-14);
        }
    }
}

TEST(CrackPlane, shear_band_lies_across_the_velocity_gradient)
{
    // Pure shear stress in xy: the conjugate planes are normal to x and to y; L says which of them slides.
    const Principal p = principal(Sym{{0, 0, 0, 100, 0, 0}});
    const Vec ex{{1, 0, 0}}, ey{{0, 1, 0}};
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {shear_along(ex, ey), {}}), ey), 0, 1e-5);
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {shear_along(ey, ex), {}}), ex), 0, 1e-5);
}

TEST(CrackPlane, tie_goes_to_the_nearest_crack_then_to_the_paper_s_plane)
{
    const Principal p = principal(Sym{{0, 0, 0, 100, 0, 0}});
    const Vec ex{{1, 0, 0}}, ey{{0, 1, 0}};
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {Mat{}, ex}), ex), 0, 1e-5);
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {Mat{}, ey}), ey), 0, 1e-5);
    // A difference of 0.1 % of |L n| is a tie too.
    const Mat nearly = {{0, 1, 0, 1.001, 0, 0, 0, 0, 0}};
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {nearly, ey}), ey), 0, 1e-5);
    const Vec paper = core::cross(p.direction[1], p.direction[0] + p.direction[2]); // eq. (12)
    EXPECT_NEAR(degrees_between(crack_normal(Mode::shear, p, {Mat{}, {}}), (1 / norm(paper)) * paper), 0, 1e-5);
}

/// B13: a mirrored or turned particle gets the mirrored or turned plane.
TEST(CrackPlane, follows_mirrors_and_turns_of_the_input)
{
    Samples samples;
    const Mat mirror{{-1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int k = 0; k < 100; ++k) {
        const Sym stress = samples.tensor(100);
        const Mat l = samples.matrix(1);
        const Vec near = samples.rotation() * Vec{{1, 0, 0}}; // decides where the motion does not
        const Mat rotation = samples.rotation();
        for (const Mat& q : {mirror, rotation, mirror * rotation})
            for (const Mode mode : {Mode::opening, Mode::shear, Mode::mixed}) {
                const Vec n = crack_normal(mode, principal(stress), {l, near});
                const Vec other = crack_normal(mode, principal(core::rotated(q, stress)), {turned(q, l), q * near});
                EXPECT_NEAR(std::abs(core::dot(q * n, other)), 1, 1e-12);
            }
    }
}

TEST(CrackPlane, equal_principal_stresses_follow_the_motion_in_any_frame)
{
    Samples samples;
    for (const Sym& stress : {Sym{{100, -50, -50, 0, 0, 0}}, Sym{{100, 100, -50, 0, 0, 0}}, Sym{{9, 9, 9, 0, 0, 0}}})
        for (int k = 0; k < 50; ++k) {
            const Mat l = samples.matrix(1);
            const Vec near = samples.rotation() * Vec{{1, 0, 0}}; // decides where the motion does not
            const Mat q = samples.rotation();
            const bool spherical = stress[0] == stress[2];
            for (const Mode mode : {Mode::opening, Mode::shear, Mode::mixed}) {
                if (spherical && mode != Mode::opening) continue;
                const Vec n = crack_normal(mode, principal(stress), {l, near});
                const Vec other = crack_normal(mode, principal(core::rotated(q, stress)), {turned(q, l), q * near});
                EXPECT_NEAR(std::abs(core::dot(q * n, other)), 1, 1e-9);
            }
        }
}

TEST(CrackPlane, spherical_tension_opens_along_the_fastest_stretch_or_the_nearest_crack)
{
    const Principal p = principal(Sym{{9, 9, 9, 0, 0, 0}});
    Mat l{};
    l(2, 2) = 1;
    EXPECT_NEAR(std::abs(crack_normal(Mode::opening, p, {l, {}})[2]), 1, 1e-12);
    EXPECT_NEAR(std::abs(crack_normal(Mode::opening, p, {Mat{}, {{0, 1, 0}}})[1]), 1, 1e-12);
    EXPECT_NEAR(norm(crack_normal(Mode::opening, p, {Mat{}, {}})), 1, 1e-12);
}
} // namespace material
