/// material/decohesion.h: mode, strengths, effective length and energy at onset against the table of methods.md D.6.
#include "material/decohesion.h"

#include "material/onset.h"
#include "material/principal.h"
#include "tests/material/samples.h"

#include <gtest/gtest.h>

#include <limits>

namespace material
{
namespace
{
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double spacing = 0.125; // mm

Decohesion paper()
{
    Decohesion law;
    law.s_max = 4900;
    law.tau_max = 820;
    law.u0 = 2e-4;
    law.snap_back = SnapBack::brittle_drop;
    return law;
}

Decohesion with_energies(double opening, double shear)
{
    Decohesion law = paper();
    law.u0.reset();
    law.energy_1 = opening;
    law.energy_2 = shear;
    return law;
}

const Sym just_opening{{4900.01, 4000, 3800, 0, 0, 0}};
const Sym just_shearing{{0, 0, 0, 820.01, 0, 0}};
const Sym just_mixed{{4900.01, 4000, 4900.01 - 2 * 820.01, 0, 0, 0}};

core::Crack crack_of(const Decohesion& law, const Sym& stress, const Mat& l = {})
{
    const auto crack = onset(law, steel(), stress, stress, {l, {}}, spacing, 1.5);
    EXPECT_TRUE(crack.has_value());
    return crack.value_or(core::Crack{});
}
} // namespace

TEST(Onset, mode_follows_the_three_criteria)
{
    const Decohesion law = paper();
    EXPECT_FALSE(onset(law, steel(), Sym{{4899, 4000, 3800, 0, 0, 0}}, Sym{}, {}, spacing, 0));
    EXPECT_EQ(crack_of(law, just_opening).mode, 1);
    EXPECT_EQ(crack_of(law, just_shearing).mode, 2);
    EXPECT_EQ(crack_of(law, just_mixed).mode, 3);

    Decohesion only_shear = law;
    only_shear.s_max = infinite;
    EXPECT_EQ(crack_of(only_shear, just_mixed).mode, 2);
    Decohesion only_opening = law;
    only_opening.tau_max = infinite;
    EXPECT_EQ(crack_of(only_opening, just_mixed).mode, 1);
}

TEST(Onset, lode_parameter_of_known_states)
{
    const auto lode = [](const Sym& stress) { return lode_parameter(principal(stress)); };
    EXPECT_NEAR(lode({{700, 0, 0, 0, 0, 0}}), -1, 1e-12);    // tension
    EXPECT_NEAR(lode({{-700, 0, 0, 0, 0, 0}}), 1, 1e-12);    // compression
    EXPECT_NEAR(lode({{0, 0, 0, 500, 0, 0}}), 0, 1e-12);     // shear
    EXPECT_NEAR(lode({{900, 500, 100, 0, 0, 0}}), 0, 1e-12); // plane strain of a metal that flows
    EXPECT_NEAR(lode({{900, 300, 100, 0, 0, 0}}), -0.5, 1e-12);
    EXPECT_EQ(lode({{300, 300, 300, 0, 0, 0}}), 0);
}

TEST(Onset, shear_strength_between_shear_and_tension_bar_is_quadratic_in_the_lode_parameter)
{
    Decohesion law = paper();
    law.s_max = infinite;
    EXPECT_EQ(crack_of(law, {{1640.02, 0, 0, 0, 0, 0}}).mode, 2); // without the key: Tresca
    law.tau_max_axial = 1000;
    const auto starts = [&](const Sym& stress) {
        return onset(law, steel(), stress, stress, {}, spacing, 0).has_value();
    };
    EXPECT_TRUE(starts({{0, 0, 0, 820.01, 0, 0}}));
    EXPECT_FALSE(starts({{0, 0, 0, 819.99, 0, 0}}));
    EXPECT_TRUE(starts({{2000.01, 0, 0, 0, 0, 0}}));
    EXPECT_FALSE(starts({{1999.99, 0, 0, 0, 0, 0}}));
    EXPECT_TRUE(starts({{-2000.01, 0, 0, 0, 0, 0}}));
    EXPECT_FALSE(starts({{-1999.99, 0, 0, 0, 0, 0}}));
    const double half_way = 820 + 0.25 * (1000 - 820);
    const auto at_half = [](double shear) { return Sym{{2 * shear, shear / 2, 0, 0, 0, 0}}; }; // L = -1/2
    EXPECT_TRUE(starts(at_half(half_way + 0.01)));
    EXPECT_FALSE(starts(at_half(half_way - 0.01)));
    EXPECT_NEAR(onset_ratio(law, principal(at_half(1.2 * half_way)), -0.5), 1.2, 1e-12);
}

TEST(Onset, strength_of_a_remembered_state_and_plane_of_the_stress)
{
    Decohesion law = paper();
    law.s_max = infinite;
    law.tau_max_axial = 1000;
    const auto start = [&](const Sym& stress, std::optional<double> lode) {
        return onset(law, steel(), stress, stress, {}, spacing, 0, lode);
    };
    const Sym shear{{0, 0, 0, 990, 0, 0}}, tension{{1700, 0, 0, 0, 0, 0}};
    EXPECT_TRUE(start(shear, {}));
    EXPECT_FALSE(start(shear, -1)); // 1000 MPa
    EXPECT_FALSE(start(tension, {}));
    ASSERT_TRUE(start(tension, 0)); // 820 MPa
    EXPECT_EQ(start(shear, 0)->normal, start(shear, {})->normal);
    EXPECT_EQ(start(shear, 0)->normal_strength, start(shear, {})->normal_strength);
}

TEST(Onset, the_cheap_test_never_clears_what_the_law_starts)
{
    Samples samples;
    int starting = 0;
    for (int k = 0; k < 20000; ++k) {
        Decohesion law = paper();
        law.s_max = samples.uniform(500, 2500);
        law.tau_max = samples.uniform(500, 2000);
        law.tau_max_axial = samples.uniform(500, 2000); // also below tau_max
        const Sym stress = samples.tensor(1000);
        const Principal p = principal(stress);
        const double lode = k % 2 == 0 ? lode_parameter(p) : samples.uniform(-1, 1);
        ASSERT_EQ(failing_mode(law, p, lode).has_value(), onset_ratio(law, p, lode) > 1);
        if (!failing_mode(law, p, lode)) continue;
        ++starting;
        ASSERT_TRUE(may_start(law, stress));
    }
    EXPECT_GT(starting, 2000);
}

TEST(Onset, starts_on_the_loading_surface)
{
    for (const Sym& stress : {just_opening, just_shearing, just_mixed}) {
        const core::Crack crack = crack_of(paper(), stress);
        const PlaneTraction t = plane_traction(stress, {crack.normal});
        const double phi =
            std::hypot(std::max(t.normal, 0.0) / crack.normal_strength, t.shear / crack.tangential_strength);
        EXPECT_NEAR(phi, 1, 1e-12);
        EXPECT_EQ(crack.damage, 0);
        EXPECT_EQ(crack.opening, 0);
        EXPECT_EQ(crack.onset_time, 1.5);
        EXPECT_EQ(crack.separation_time, -1);
    }
}

TEST(Onset, strengths_are_the_active_ones_and_keep_the_ratio_c_m)
{
    const core::Crack opening = crack_of(paper(), just_opening);
    EXPECT_NEAR(opening.normal_strength, 4900.01, 1e-6);
    EXPECT_NEAR(opening.tangential_strength / opening.normal_strength, 100, 1e-10);
    const core::Crack shear = crack_of(paper(), just_shearing);
    EXPECT_NEAR(shear.tangential_strength, 820.01, 1e-6);
    EXPECT_NEAR(shear.tangential_strength / shear.normal_strength, 0.01, 1e-14);
    // Actual tractions on the 22.5 degree plane, methods.md D.6: tau_n = 4660, tau_t = 580.
    const core::Crack mixed = crack_of(paper(), just_mixed);
    const PlaneTraction t = plane_traction(just_mixed, {mixed.normal});
    EXPECT_NEAR(t.normal, 4660, 1);
    EXPECT_NEAR(t.shear, 580, 1);
    EXPECT_NEAR(mixed.normal_strength, std::hypot(t.normal, t.shear), 1e-9);
}

TEST(Onset, paper_strength_is_equation_ten)
{
    Decohesion law = paper();
    law.onset_strength = OnsetStrength::paper;
    EXPECT_NEAR(crack_of(law, just_opening).normal_strength, std::hypot(4900.01, 550.005 / 100), 1e-9);
    EXPECT_NEAR(crack_of(law, just_mixed).normal_strength, std::hypot(4900.01, 820.01), 1e-6);
}

TEST(Onset, effective_length_projects_the_cell_on_the_normal)
{
    EXPECT_NEAR(crack_of(paper(), just_opening).effective_length, spacing, 1e-12);
    const Sym diagonal{{820.01, -820.01, 0, 0, 0, 0}}; // shear plane at 45 degrees
    EXPECT_NEAR(crack_of(paper(), diagonal).effective_length, std::sqrt(2.0) * spacing, 1e-12);
    EXPECT_NEAR(crack_of(paper(), just_mixed).effective_length, 1.307 * spacing, 1e-4);
    Decohesion wide = paper();
    wide.band_factor = 1.3;
    EXPECT_NEAR(crack_of(wide, just_opening).effective_length, 1.3 * spacing, 1e-12);
}

/// methods.md D.6, rows I, II and mixed of the paper's values.
TEST(Onset, reproduces_the_snap_back_table)
{
    const core::Crack opening = crack_of(paper(), just_opening);
    EXPECT_NEAR(opening.surface_energy, 0.980, 1e-3);
    EXPECT_NEAR(fracture_energy(1, opening), 0.490, 5e-4);
    EXPECT_NEAR(critical_length(steel(), 1, opening, {4900, 0}), 10.7e-3, 0.05e-3);
    EXPECT_NEAR(opening.snap_back_ratio, 11.7, 0.05);
    const core::Crack shear = crack_of(paper(), just_shearing);
    EXPECT_NEAR(shear.surface_energy, 0.164, 1e-4);
    EXPECT_NEAR(critical_length(steel(), 1, shear, {0, 820}), 18.3e-3, 0.05e-3);
    EXPECT_NEAR(shear.snap_back_ratio, 6.8, 0.05);
    const core::Crack mixed = crack_of(paper(), just_mixed);
    // The table gives 10.5 um and 15.6 with M for both tractions; the 1.5 % of loading in shear has the modulus mu.
    EXPECT_NEAR(mixed.surface_energy, 0.940, 5e-3);
    EXPECT_NEAR(mixed.snap_back_ratio, 14.8, 0.3);
}

TEST(Onset, brittle_drop_keeps_the_energy_and_remembers_the_tractions)
{
    const core::Crack crack = crack_of(paper(), just_shearing);
    EXPECT_NEAR(crack.drop_traction[0], 0, 1e-9);
    EXPECT_NEAR(crack.drop_traction[1], 820.01, 1e-9);
}

TEST(Onset, energy_floor_is_kappa_times_the_stored_energy)
{
    Decohesion law = with_energies(0.49, 0.082);
    law.snap_back = SnapBack::energy_floor;
    const core::Crack opening = crack_of(law, just_opening);
    EXPECT_NEAR(fracture_energy(1, opening), 1.2 * 4900 * 4900 * spacing / (2 * 262500), 1e-3);
    EXPECT_NEAR(2 * fracture_energy(1, opening) / 4900, 2.8e-3, 0.01e-3); // opening at separation, D.7
    const core::Crack shear = crack_of(law, Sym{{820.01, -820.01, 0, 0, 0, 0}});
    EXPECT_NEAR(fracture_energy(1, shear), 1.2 * 820 * 820 * std::sqrt(2.0) * spacing / (2 * 75000), 1e-4);
    EXPECT_NEAR(2 * fracture_energy(1, shear) / 820, 2.3e-3, 0.02e-3);
    // A tough material is left alone.
    law.energy_1 = law.energy_2 = 20;
    EXPECT_NEAR(fracture_energy(1, crack_of(law, just_opening)), 20, 1e-12);
    EXPECT_LT(crack_of(law, just_opening).snap_back_ratio, 1);
}

TEST(Onset, fracture_energy_is_the_input_for_any_exponent)
{
    for (const double q : {0.5, 1.0, 2.0}) {
        Decohesion law = with_energies(30, 20);
        law.q = q;
        EXPECT_NEAR(fracture_energy(q, crack_of(law, just_opening)), 30, 1e-12);
        EXPECT_NEAR(fracture_energy(q, crack_of(law, just_shearing)), 20, 1e-12);
        const double mixed = fracture_energy(q, crack_of(law, just_mixed));
        EXPECT_GT(mixed, 29);
        EXPECT_LT(mixed, 30); // mostly opening on that plane
    }
}

TEST(Onset, strength_covers_the_smoothed_and_the_own_stress)
{
    const Sym test{{0, 0, 0, 830, 0, 0}};
    const Mat l{{0, 1, 0, 0, 0, 0, 0, 0, 0}};
    const auto weaker = onset(paper(), steel(), test, Sym{{0, 0, 0, 700, 0, 0}}, {l, {}}, spacing, 0);
    const auto stronger = onset(paper(), steel(), test, Sym{{0, 0, 0, 900, 0, 0}}, {l, {}}, spacing, 0);
    EXPECT_NEAR(weaker->tangential_strength, 830, 1e-9);
    EXPECT_NEAR(stronger->tangential_strength, 900, 1e-9);
    EXPECT_FALSE(onset(paper(), steel(), Sym{{0, 0, 0, 810, 0, 0}}, Sym{{0, 0, 0, 900, 0, 0}}, {l, {}}, spacing, 0));
}

/// Only the tractions on the weak plane count, whatever the stress is elsewhere.
TEST(Onset, weak_plane_is_the_only_one_that_breaks)
{
    Decohesion law = paper();
    law.weak_plane = {0, 1, 0};
    EXPECT_FALSE(onset(law, steel(), Sym{{9000, 0, 0, 0, 0, 0}}, Sym{}, {}, spacing, 0));   // along the plane
    EXPECT_FALSE(onset(law, steel(), Sym{{0, 4800, 0, 800, 0, 0}}, Sym{}, {}, spacing, 0)); // below both
    const Sym opening{{9000, 4901, 0, 0, 0, 0}}, shearing{{9000, 0, 0, 0, 821, 0}}, mixed{{0, 4901, 0, 821, 0, 0}};
    EXPECT_EQ(crack_of(law, opening).mode, 1);
    EXPECT_EQ(crack_of(law, shearing).mode, 2);
    EXPECT_EQ(crack_of(law, mixed).mode, 3);
    for (const Sym& stress : {opening, shearing, mixed}) {
        EXPECT_EQ(crack_of(law, stress).normal, (std::array<double, 3>{0, 1, 0}));
        EXPECT_EQ(crack_of(law, stress).effective_length, spacing);
    }
}

/// B29: near both thresholds the mode may follow the noise; away from them it may not.
TEST(Onset, ratio_on_a_plane_exceeds_one_where_the_plane_breaks)
{
    const Decohesion law = paper();
    EXPECT_EQ(onset_ratio(law, {2 * law.s_max, 0.5 * law.tau_max}), 2);
    EXPECT_EQ(onset_ratio(law, {-2 * law.s_max, 0.5 * law.tau_max}), 0.5);
    Samples samples;
    for (int i = 0; i < 100; ++i) {
        const PlaneTraction traction{samples.uniform(-2, 2) * law.s_max, samples.uniform(0, 2) * law.tau_max};
        EXPECT_EQ(onset_ratio(law, traction) > 1, failing_mode(law, traction).has_value());
    }
}

TEST(Onset, mode_is_stable_away_from_the_double_threshold)
{
    Samples samples;
    const Sym clear{{4910, 4000, 4910 - 2 * 815, 0, 0, 0}}; // s_1 0.2 % above, tau_t 0.6 % below
    int same = 0;
    for (int k = 0; k < 1000; ++k) {
        const Sym noise = samples.tensor(0.001 * 815);
        same += crack_of(paper(), clear + noise).mode == 1;
    }
    EXPECT_GE(same, 950);
}
} // namespace material
