/// material/renewed_plane.h: where the loading turns a softening crack goes on along another plane (B14); energy,
/// ledger.
#include "material/renewed_plane.h"

#include "material/decohesion.h"
#include "material/principal.h"
#include "tests/material/samples.h"

#include <gtest/gtest.h>

namespace material
{
namespace
{
constexpr double energy = 0.5;   // N/mm
constexpr double spacing = 0.01; // mm, a twentieth of L_crit
constexpr double strength = 600; // MPa, in shear

Material metal(bool renewed)
{
    Material material;
    material.elastic = steel();
    Decohesion law;
    law.s_max = 1000;
    law.tau_max = strength;
    law.energy_1 = law.energy_2 = energy;
    law.renewed_plane = renewed;
    material.decohesion = law;
    return material;
}

/// A particle after its onset in shear in the plane xy: its crack lies across y or x.
struct Probe
{
    SeparationLaw law;
    core::Crack crack;
    Sym stress = 1.000001 * Sym{{0, 0, 0, strength, 0, 0}};
    double stored = 0, work = 0, dissipated = 0; // mJ/mm^3
    double crack_energy = 0;                     // N/mm, dissipated per area of the plane at the time
    double largest = 0;                          // MPa, (s_1 - s_3) / 2 while it softens

    explicit Probe(bool renewed) : law(separation_law(metal(renewed)))
    {
        crack = onset(*metal(renewed).decohesion, steel(), stress, stress, {}, spacing, 0).value();
        stored = elastic_energy(steel(), stress);
    }

    void strain(const Sym& increment, int steps)
    {
        for (int i = 0; i < steps && crack.damage < 1; ++i) {
            const DecohesionStep step = separate(law, crack, {stress, increment, {}, 0, 1e-6, 0});
            work += core::contract(0.5 * (stress + step.stress), increment);
            dissipated += step.decohesion_work;
            crack_energy += step.decohesion_work * crack.effective_length;
            stress = step.stress;
            crack = step.crack;
            if (crack.damage == 1) break;
            const Principal principal_stress = principal(stress);
            largest = std::max(largest, (principal_stress.value[0] - principal_stress.value[2]) / 2);
        }
    }
    Vec normal() const { return {crack.normal}; }
};

const Sym along_xy{{0, 0, 0, 1e-5, 0, 0}};
const Sym turned{{1e-5, -1e-5, 0, 0, 0, 0}}; // shear by 45 degrees from the first: none on the first plane
} // namespace

TEST(RenewedPlane, a_fixed_plane_does_not_see_shear_by_45_degrees_from_it)
{
    Probe probe(false);
    probe.strain(along_xy, 300);
    const Vec normal = probe.normal();
    probe.strain(turned, 3000);
    EXPECT_LT(probe.crack.damage, 1);
    EXPECT_GT(probe.largest, 5 * strength);
    EXPECT_LT(norm(probe.normal() - normal), 0.02);
}

TEST(RenewedPlane, the_crack_goes_on_where_the_stress_reaches_its_strength_and_dissipates_what_is_left)
{
    Probe probe(true);
    probe.strain(along_xy, 300);
    const double begun = probe.crack.damage;
    EXPECT_GT(begun, 0.03);
    EXPECT_LT(begun, 0.5);
    probe.strain(turned, 30000);
    EXPECT_EQ(probe.crack.damage, 1);
    EXPECT_LT(probe.largest, 1.06 * strength);
    EXPECT_NEAR(std::abs(probe.normal()[0] * probe.normal()[1]), 0.5, 0.06); // 45 degrees to the first
    // More than G_f: at a jump the stress of the new plane is beyond the strength that is left, and falls to it at
    // once.
    EXPECT_GT(probe.crack_energy / energy, 1);
    EXPECT_LT(probe.crack_energy / energy, 1.2);
}

TEST(RenewedPlane, balances_energy)
{
    Probe probe(true);
    probe.strain(along_xy, 300);
    probe.strain(turned, 30000);
    const double balance = probe.stored + probe.work - probe.dissipated - elastic_energy(steel(), probe.stress);
    EXPECT_LT(std::abs(balance), 2e-3 * probe.dissipated);
}

TEST(RenewedPlane, stays_where_the_loading_does_not_turn)
{
    Probe renewed(true), fixed(false);
    for (int i = 0; i < 2000; ++i) {
        renewed.strain(along_xy, 1);
        fixed.strain(along_xy, 1);
        ASSERT_EQ(norm(renewed.stress - fixed.stress), 0);
    }
    EXPECT_GT(renewed.crack.damage, 0.2);
}
} // namespace material
