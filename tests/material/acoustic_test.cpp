/// Acoustic tensor of von Mises (material/acoustic.h) against the numerical tangent of the return mapping, searched
/// over all planes.
#include "material/acoustic.h"

#include "material/crack_plane.h"
#include "material/decohesion.h"
#include "material/elastic.h"
#include "material/von_mises.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
constexpr double pi = std::numbers::pi;

/// Paper's steel with any plastic modulus H [MPa].
struct Steel
{
    material::Elastic elastic{7.81e-3, 195000, 0.3};
    double hardening = 0;

    material::PlasticConstants<double> plastic() const
    {
        return {1100, hardening, 3 * elastic.shear_modulus(), 1 / (3 * elastic.shear_modulus() + hardening)};
    }
    core::Sym<double> stress_after(const core::Sym<double>& stress, const core::Sym<double>& strain,
                                   double eq_plastic_strain) const
    {
        const auto trial = material::elastic_trial(stress, strain, material::lame_constants<double>(elastic));
        return material::radial_return(trial, eq_plastic_strain, plastic()).stress;
    }
};

/// A stress on the yield surface with the given principal deviator angle (0: uniaxial tension, 30 degrees: shear).
core::Sym<double> yielding(double lode, double mean)
{
    const double r = 1100 * 2 / 3.0;
    core::Sym<double> s{};
    for (int i = 0; i < 3; ++i) s[i] = mean + r * std::cos(lode - 2 * pi * i / 3);
    const core::Mat<double> turn{{0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6}};
    return core::rotated(turn, s);
}

/// n . C_ep . n from steps of plastic loading; direction j of the jump is column j.
core::Mat<double> acoustic(const Steel& steel, const core::Sym<double>& stress, const core::Vec<double>& n)
{
    // Along the flow first, so that every probe loads; the response to it is subtracted.
    const double mean = core::trace(stress) / 3, size = 1e-8;
    core::Sym<double> flow = stress;
    for (int i = 0; i < 3; ++i) flow[i] -= mean;
    flow = (1e-6 / 1100) * flow;
    const core::Sym<double> base = steel.stress_after(stress, flow, 0);
    core::Mat<double> q{};
    for (int j = 0; j < 3; ++j) {
        core::Mat<double> jump{};
        for (int i = 0; i < 3; ++i) jump(j, i) = size * n[i];
        const core::Sym<double> change = steel.stress_after(stress, flow + core::symmetric_part(jump), 0) - base;
        const core::Vec<double> traction = change * n;
        for (int i = 0; i < 3; ++i) q(i, j) = traction[i] / size;
    }
    return q;
}

double least_ratio(const Steel& steel, const core::Sym<double>& stress, core::Vec<double>& plane)
{
    const double mu = steel.elastic.shear_modulus();
    const double elastic = mu * mu * steel.elastic.wave_modulus();
    double least = 2;
    for (int a = 0; a <= 90; ++a)
        for (int b = 0; b < 180; ++b) {
            const double theta = a * pi / 180, phi = b * pi / 90;
            const core::Vec<double> n{
                {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}};
            const double ratio = core::determinant(acoustic(steel, stress, n)) / elastic;
            if (ratio < least) {
                least = ratio;
                plane = n;
            }
        }
    return least;
}
} // namespace

TEST(Acoustic, is_the_least_over_all_planes)
{
    for (const double hardening : {0.0, 1156.8, 60000.0})
        for (const double lode : {0.0, 0.2, pi / 6, 0.9}) {
            SCOPED_TRACE(testing::Message() << "H = " << hardening << ", Lode angle " << lode);
            const Steel steel{{7.81e-3, 195000, 0.3}, hardening};
            const core::Sym<double> stress = yielding(lode, 700);
            const material::Bifurcation found = material::bifurcation(steel.elastic, hardening, stress);
            core::Vec<double> plane{};
            EXPECT_NEAR(found.ratio, least_ratio(steel, stress, plane), 2e-3);
            const double mu = steel.elastic.shear_modulus();
            EXPECT_NEAR(core::determinant(acoustic(steel, stress, found.normal)) /
                            (mu * mu * steel.elastic.wave_modulus()),
                        found.ratio, 1e-4);
        }
}

// The paper's claim, as far as it goes: with H -> 0 bifurcation and the shear strength agree, in time and plane, where
// the intermediate deviator vanishes. With hardening there is no bifurcation before any peak strength.
TEST(Acoustic, perfect_plasticity_in_shear_is_the_shear_criterion)
{
    const Steel steel;
    const core::Sym<double> stress = yielding(pi / 6, 700);
    const material::Bifurcation found = material::bifurcation(steel.elastic, 0, stress);
    EXPECT_NEAR(found.ratio, 0, 1e-12);
    material::Decohesion law;
    law.s_max = 1e9;
    law.tau_max = (1 - 1e-9) * 1100 / std::sqrt(3);
    law.u0 = 1e-4;
    const auto crack = material::onset(law, steel.elastic, stress, stress, {}, 0.125, 0);
    ASSERT_TRUE(crack);
    const material::Principal principal = material::principal(stress);
    for (const int i : {0, 2}) // the same plane or its conjugate
        EXPECT_NEAR(std::abs(core::dot(found.normal, principal.direction[static_cast<std::size_t>(i)])),
                    std::abs(core::dot({crack->normal}, principal.direction[static_cast<std::size_t>(i)])), 1e-9);
}

TEST(Acoustic, hardening_never_bifurcates)
{
    const material::Elastic elastic{7.81e-3, 195000, 0.3};
    for (double lode = 0; lode < pi / 3; lode += 0.01) {
        const auto found = material::bifurcation(elastic, 1156.8, yielding(lode, 0));
        EXPECT_GT(found.ratio, 0.005);
        EXPECT_LE(found.critical_hardening, 1e-6);
        EXPECT_NEAR(material::bifurcation(elastic, found.critical_hardening, yielding(lode, 0)).ratio, 0, 1e-9);
    }
}
