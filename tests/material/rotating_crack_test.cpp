/// material/rotating_crack.h: where the stress at onset leaves the plane open the strain decides; energy, ledger, B14.
#include "material/rotating_crack.h"

#include "material/principal.h"
#include "tests/material/probe.h"

#include <limits>

namespace material
{
namespace
{
constexpr double energy = 0.5; // N/mm

Material brittle(double rotating_until)
{
    Material material;
    material.elastic = steel();
    Decohesion law;
    law.s_max = 1000;
    law.tau_max = std::numeric_limits<double>::infinity();
    law.energy_1 = law.energy_2 = energy;
    law.rotating_until = rotating_until;
    material.decohesion = law;
    return material;
}

/// Ahead of a mode I tip: equal tension along and across the path, and a breath of shear that turns the axes by 45
/// degrees (C19).
const Sym tip_stress{{1000, 1000, 600, 1e-3, 0, 0}};
constexpr double spacing = 0.02; // mm, a tenth of L_crit

/// Stretch across the path only, until nothing more can soften.
Probe opened(double rotating_until)
{
    Probe probe(brittle(rotating_until), tip_stress, spacing);
    for (int i = 0; i < 20000; ++i) probe.strain(1e-5 * Sym{{0, 1, 0, 0, 0, 0}});
    return probe;
}
} // namespace

TEST(RotatingCrack, a_plane_fixed_at_onset_stands_askew_and_locks)
{
    const Probe probe = opened(0);
    EXPECT_NEAR(std::abs(probe.normal()[1]), std::sqrt(0.5), 0.3); // 45 degrees, less what the material turns it
    EXPECT_GT(equivalent(probe.stress), 10 * 1000);
}

TEST(RotatingCrack, a_rotating_plane_stands_across_the_strain_and_dissipates_the_energy)
{
    const Probe probe = opened(1);
    EXPECT_EQ(probe.crack.damage, 1);
    EXPECT_GT(std::abs(probe.normal()[1]), std::cos(0.02));
    EXPECT_NEAR(probe.crack.effective_length / spacing, 1, 0.03);
    EXPECT_NEAR(probe.dissipated() / energy, 1, 0.02);
    EXPECT_LT(std::abs(probe.stress[1]), 1);
    EXPECT_LT(probe.stress[0], 1000); // the tension along the path at onset, less what the opening released of it
}

TEST(RotatingCrack, keeps_its_plane_from_the_given_damage_on)
{
    Probe probe(brittle(0.25), tip_stress, spacing);
    while (probe.crack.damage < 0.25) probe.strain(1e-6 * Sym{{0, 1, 0, 0, 0, 0}});
    const Vec normal = probe.normal();
    EXPECT_GT(std::abs(normal[1]), 0.9);
    for (int i = 0; i < 500; ++i) probe.strain(1e-5 * Sym{{0, 0, 0, 1, 0, 0}}); // would turn it by 0.3
    EXPECT_LT(norm(probe.normal() - normal), 0.02);
}

TEST(RotatingCrack, without_shear_it_is_the_fixed_crack)
{
    Probe rotating(brittle(1), Sym{{1001, 200, 100, 0, 0, 0}}, spacing);
    Probe fixed(brittle(0), Sym{{1001, 200, 100, 0, 0, 0}}, spacing);
    for (int i = 0; i < 3000; ++i) {
        const Sym step = 1e-5 * Sym{{1, 0.1, -0.2, 0, 0, 0}};
        rotating.strain(step);
        fixed.strain(step);
        ASSERT_LT(norm(rotating.stress - fixed.stress), 1e-8);
    }
    EXPECT_NEAR(rotating.crack.damage, fixed.crack.damage, 1e-12);
    EXPECT_NEAR(rotating.decohesion_work, fixed.decohesion_work, 1e-10);
}

/// What the turning of the plane frees is counted: work = stored + dissipated at every moment of a turning path.
TEST(RotatingCrack, balances_energy_while_it_turns)
{
    Probe probe(brittle(1), Sym{{1001, 0, 0, 0, 0, 0}}, spacing);
    double worst = 0;
    for (int i = 0; i < 30000; ++i) {
        probe.strain(1e-6 * Sym{{0.5, 0.75, 0, 0.5, 0, 0}});
        worst = std::max(worst, std::abs(probe.missing_energy(steel())));
    }
    EXPECT_GT(std::abs(probe.normal()[1]), 0.5); // it did turn
    EXPECT_LT(worst, 2e-3 * probe.decohesion_work);
}

/// Turned where the tension is high, back where it is low, round after round: none gives work back. (Every step of a
/// probe must not.)
TEST(RotatingCrack, turning_to_and_fro_gives_no_work_back)
{
    Probe probe(brittle(1), Sym{{1001, 0, 0, 0, 0, 0}}, spacing);
    double worst = 0;
    const auto strain = [&](const Sym& direction, int steps) {
        for (int i = 0; i < steps; ++i) {
            probe.strain(1e-6 * direction);
            worst = std::max(worst, std::abs(probe.missing_energy(steel())));
        }
    };
    const Sym open{{1, 0, 0, 0, 0, 0}}, turn{{0, 0, 0, 1, 0, 0}}, unload{{-0.5, -0.5, 0, 0, 0, 0}};
    strain(open, 4000);
    for (int round = 0; round < 4; ++round) {
        const double before = probe.decohesion_work;
        strain(turn, 3000);
        EXPECT_GT(std::abs(probe.normal()[1]), 0.2);
        strain(unload, 3000);
        strain(-1.0 * turn, 3000);
        EXPECT_LT(std::abs(probe.normal()[1]), 0.01);
        strain(-1.0 * unload, 3000);
        EXPECT_GE(probe.decohesion_work, before);
    }
    EXPECT_LT(worst, 2e-3 * probe.decohesion_work);
}

/// B14, Willam, Pramono & Sture 1987: the fixed crack carries more than four strengths before it is through
/// (tests/material/separation_test.cpp). The rotating one only what the strain along its second axis makes, which no
/// single plane sees: E e_2 = 0.1 E e_1.
TEST(RotatingCrack, follows_the_axes_of_willam)
{
    const auto largest = [](double rotating_until) {
        Material material = brittle(rotating_until);
        material.elastic = {2.4e-3, 10e3, 0.2};
        material.decohesion->s_max = 1;
        material.decohesion->energy_1 = material.decohesion->energy_2 = 1e-3;
        Probe probe(material, Sym{{1.000001, 0, 0, 0, 0, 0}}, 1.0);
        double stress = 0;
        for (int i = 0; i < 20000 && probe.crack.damage < 1; ++i) {
            probe.strain(5e-7 * Sym{{0.5, 0.75, 0, 0.5, 0, 0}});
            stress = std::max(stress, principal(probe.stress).value[0]);
        }
        EXPECT_EQ(probe.crack.damage, 1);
        return stress;
    };
    EXPECT_GT(largest(0), 4);
    EXPECT_LT(largest(1), 2);
}
} // namespace material
