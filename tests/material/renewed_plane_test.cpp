/// material/renewed_plane.h: where the loading turns a softening crack goes on along another plane (B14); energy,
/// ledger.
#include "material/renewed_plane.h"

#include "material/principal.h"
#include "tests/material/probe.h"

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

/// After its onset in shear in the plane xy: the crack lies across y or x.
struct Sheared : Probe
{
    double crack_energy = 0; // N/mm, dissipated per area of the plane at the time
    double largest = 0;      // MPa, (s_1 - s_3) / 2 while it softens

    explicit Sheared(bool renewed) : Probe(metal(renewed), {{0, 0, 0, strength, 0, 0}}, spacing) {}

    void go_on(const Sym& increment, int steps)
    {
        for (int i = 0; i < steps && crack.damage < 1; ++i) {
            const double work = decohesion_work, length = crack.effective_length;
            strain(increment);
            crack_energy += (decohesion_work - work) * length;
            if (crack.damage == 1) break;
            const Principal principal_stress = principal(stress);
            largest = std::max(largest, (principal_stress.value[0] - principal_stress.value[2]) / 2);
        }
    }
};

const Sym along_xy{{0, 0, 0, 1e-5, 0, 0}};
const Sym turned{{1e-5, -1e-5, 0, 0, 0, 0}}; // shear by 45 degrees from the first: none on the first plane
} // namespace

TEST(RenewedPlane, a_fixed_plane_does_not_see_shear_by_45_degrees_from_it)
{
    Sheared probe(false);
    probe.go_on(along_xy, 300);
    const Vec normal = probe.normal();
    probe.go_on(turned, 3000);
    EXPECT_LT(probe.crack.damage, 1);
    EXPECT_GT(probe.largest, 5 * strength);
    EXPECT_LT(norm(probe.normal() - normal), 0.02);
}

TEST(RenewedPlane, the_crack_goes_on_where_the_stress_reaches_its_strength_and_dissipates_what_is_left)
{
    Sheared probe(true);
    probe.go_on(along_xy, 300);
    const double begun = probe.crack.damage;
    EXPECT_GT(begun, 0.03);
    EXPECT_LT(begun, 0.5);
    probe.go_on(turned, 30000);
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
    Sheared probe(true);
    probe.go_on(along_xy, 300);
    probe.go_on(turned, 30000);
    EXPECT_LT(std::abs(probe.missing_energy(steel())), 2e-3 * probe.decohesion_work);
}

TEST(RenewedPlane, stays_where_the_loading_does_not_turn)
{
    Sheared renewed(true), fixed(false);
    for (int i = 0; i < 2000; ++i) {
        renewed.strain(along_xy);
        fixed.strain(along_xy);
        ASSERT_EQ(norm(renewed.stress - fixed.stress), 0);
    }
    EXPECT_GT(renewed.crack.damage, 0.2);
}
} // namespace material
