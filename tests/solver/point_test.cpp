/// solver/point_path.h: closed solutions of elasticity and plasticity, energy of cracks (methods.md C16), unloading,
/// closure, what has no solution.
#include "solver/point_path.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace solver
{
namespace
{
using Strains = std::array<std::optional<Real>, 6>;
constexpr std::optional<Real> free_component = std::nullopt;

material::Material steel()
{
    material::Material material;
    material.elastic = {7.81e-3, 195e3, 0.3};
    return material;
}

material::Material plastic_steel(Real tangent_modulus = 1150)
{
    material::Material material = steel();
    material.plastic = material::VonMises{1100, tangent_modulus};
    return material;
}

/// Energies for which a cell of 0.25 mm softens without snap-back.
material::Material breaking_steel(Real s_max = 4900, Real tau_max = 820)
{
    material::Material material = plastic_steel();
    material::Decohesion law;
    law.s_max = s_max;
    law.tau_max = tau_max;
    law.energy_1 = 25;
    law.energy_2 = 5;
    material.decohesion = law;
    return material;
}

std::vector<PointState> followed(const material::Material& material, const std::vector<PointSegment>& segments)
{
    std::vector<PointState> history;
    follow({material, 0.25, 1e-5, segments}, [&](const PointState& state) { history.push_back(state); });
    return history;
}

PointSegment uniaxial_strain(std::int64_t steps, Real strain)
{
    return {steps, Strains{strain, 0, 0, 0, 0, 0}};
}

PointSegment uniaxial_stress(std::int64_t steps, Real strain)
{
    return {steps, Strains{strain}};
}

Real dissipated(const PointState& state)
{
    return state.decohesion_work * state.crack->effective_length;
}

TEST(Point, uniaxial_tension_has_youngs_modulus_yield_and_tangent_modulus)
{
    const Real yield_strain = 1100 / 195e3;
    for (const PointState& state : followed(plastic_steel(), {uniaxial_stress(157, 0.05)})) {
        const Real strain = state.strain[0];
        const Real expected = strain < yield_strain ? 195e3 * strain : 1100 + 1150 * (strain - yield_strain);
        EXPECT_NEAR(state.stress[0], expected, 1e-6) << state.step;
        for (int i = 1; i < 6; ++i) EXPECT_NEAR(state.stress[i], 0, 2e-7) << state.step;
        const Real elastic = state.stress[0] / 195e3; // nu = 0.3, plastic flow without change of volume
        EXPECT_NEAR(state.strain[1], -0.3 * elastic - 0.5 * (strain - elastic), 1e-11) << state.step;
        EXPECT_NEAR(state.strain[2], state.strain[1], 1e-11);
    }
}

TEST(Point, plastic_work_and_stored_energy_are_the_work_of_the_stress)
{
    Real work = 0;
    const std::vector<PointState> history = followed(plastic_steel(), {uniaxial_stress(2000, 0.05)});
    for (std::size_t n = 1; n < history.size(); ++n)
        work +=
            0.5 * (history[n - 1].stress[0] + history[n].stress[0]) * (history[n].strain[0] - history[n - 1].strain[0]);
    const PointState& end = history.back();
    EXPECT_NEAR(end.plastic_work + 0.5 * end.stress[0] * end.stress[0] / 195e3, work, 1e-4 * work);
}

TEST(Point, stress_control_reaches_its_target_and_comes_back)
{
    PointSegment load{10, {}, core::Sym<Real>{{1000, -200, 0, 150, 0, 0}}};
    const PointState loaded = followed(steel(), {load}).back();
    EXPECT_NEAR(loaded.strain[0], (1000 + 0.3 * 200) / 195e3, 1e-14);
    EXPECT_NEAR(loaded.strain[2], -0.3 * (1000 - 200) / 195e3, 1e-14);
    EXPECT_NEAR(loaded.strain[3], 150 / (2 * 75e3), 1e-14);
    load.stress = {{1300, -200, 0, 150, 0, 0}}; // beyond yield, then back to nothing: plastic strain stays
    const PointState unloaded = followed(plastic_steel(), {load, {10, {}}}).back();
    EXPECT_GT(unloaded.eq_plastic_strain, 0.1);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(unloaded.stress[i], 0, 2e-7);
    EXPECT_NEAR(core::trace(unloaded.strain), 0, 1e-10);
}

/// Jaumann rate: sigma_xy = mu sin(gamma), sigma_xx = mu (1 - cos(gamma)), exact as the steps get small.
TEST(Point, simple_shear_with_its_spin)
{
    const auto error = [](std::int64_t steps) {
        const PointSegment shear{steps, Strains{0, 0, 0, 0.5, 0, 0}, {}, {{0, 0, -0.5}}}; // gamma = 1
        const core::Sym<Real> s = followed(steel(), {shear}).back().stress;
        EXPECT_NEAR(s[0], -s[1], 1e-8 * 75e3);
        return std::max(std::abs(s[3] / 75e3 - std::sin(1.0)), std::abs(s[0] / 75e3 - (1 - std::cos(1.0))));
    };
    EXPECT_LT(error(1000), 1e-6);
    EXPECT_NEAR(error(1000) / error(2000), 4, 0.02);
}

TEST(Point, rigid_rotation_turns_the_stress_only)
{
    const PointSegment pull = uniaxial_strain(10, 1e-3);
    const PointSegment turn{4000, Strains{1e-3, 0, 0, 0, 0, 0}, {}, {{0, 0, std::acos(0.0)}}}; // a quarter, about z
    const std::vector<PointState> history = followed(steel(), {pull, turn});
    const core::Sym<Real>&before = history[10].stress, &after = history.back().stress;
    EXPECT_NEAR(after[1], before[0], 1e-4);
    EXPECT_NEAR(after[0], before[1], 1e-4);
    EXPECT_NEAR(core::trace(after), core::trace(before), 1e-9);
}

TEST(Point, opening_dissipates_the_fracture_energy)
{
    const std::vector<PointState> history = followed(breaking_steel(), {uniaxial_strain(6000, 0.06)});
    const PointState& end = history.back();
    ASSERT_TRUE(end.crack);
    EXPECT_EQ(end.crack->mode, 1);
    EXPECT_EQ(end.crack->damage, 1);
    EXPECT_DOUBLE_EQ(end.crack->effective_length, 0.25);
    EXPECT_LT(end.crack->snap_back_ratio * 1.2, 1) << "the energy floor must not act";
    EXPECT_NEAR(dissipated(end) / 25, 1, 5e-3);
    EXPECT_NEAR(end.stress[0], 0, 1e-9);
    // The strength is met within the stress of one step, which changes nothing yet.
    EXPECT_NEAR(end.crack->normal_strength, 4900, 262500 * 1e-5);
    const auto onset = static_cast<std::size_t>(end.onset_step);
    EXPECT_FALSE(history[onset - 1].crack);
    EXPECT_EQ(history[onset].crack->damage, 0);
    EXPECT_EQ(history[onset].stress[0], end.crack->normal_strength);
}

TEST(Point, shear_dissipates_the_fracture_energy)
{
    const PointState end = followed(breaking_steel(), {{6000, Strains{{{}, {}, {}, 0.3}}}}).back();
    ASSERT_TRUE(end.crack);
    EXPECT_EQ(end.crack->mode, 2);
    EXPECT_EQ(end.crack->damage, 1);
    EXPECT_NEAR(end.crack->tangential_strength, 820, 0.5);
    EXPECT_LT(end.crack->snap_back_ratio * 1.2, 1);
    EXPECT_NEAR(dissipated(end) / 5, 1, 5e-3);
    EXPECT_NEAR(end.stress[3], 0, 1e-9);
}

/// The spin of simple shear says which of the two conjugate planes slides: the one whose normal is y.
TEST(Point, spin_chooses_between_conjugate_planes)
{
    for (const Real spin : {-1e-3, 1e-3}) {
        const PointSegment shear{300, Strains{0, 0, 0, 0.02, 0, 0}, {}, {{0, 0, 20 * spin}}};
        const PointState end = followed(breaking_steel(4900, 500), {shear}).back();
        ASSERT_TRUE(end.crack);
        EXPECT_GT(std::abs(end.crack->normal[spin < 0 ? 1 : 0]), 0.99) << spin;
    }
}

TEST(Point, unloading_is_elastic_and_reloading_goes_on)
{
    const std::vector<PointState> history =
        followed(breaking_steel(), {uniaxial_strain(3500, 0.035), uniaxial_strain(500, 0.03),
                                    uniaxial_strain(500, 0.035), uniaxial_strain(2500, 0.06)});
    const PointState &before = history[3500], &unloaded = history[4000], &again = history[4500];
    EXPECT_GT(before.crack->damage, 0.1);
    EXPECT_LT(before.crack->damage, 0.9);
    EXPECT_EQ(unloaded.crack->damage, before.crack->damage);
    EXPECT_NEAR(before.stress[0] - unloaded.stress[0], 262500 * 0.005, 1e-6); // P-wave modulus
    EXPECT_NEAR(again.stress[0], before.stress[0], 1e-6);
    EXPECT_EQ(again.decohesion_work, before.decohesion_work);
    EXPECT_NEAR(dissipated(history.back()) / 25, 1, 5e-3);
}

TEST(Point, closed_crack_carries_compression)
{
    const std::vector<PointState> history =
        followed(breaking_steel(), {uniaxial_strain(6000, 0.06), uniaxial_strain(8000, -0.02)});
    // The faces gave way to a lateral stress at yield: what closes flows at once, with the tangent of uniaxial strain.
    const Real hardening = 1156.8, three_mu = 225e3; // H = E E_T / (E - E_T)
    const Real modulus = 162500 + 4.0 / 9 * three_mu * hardening / (three_mu + hardening);
    const Real contact = 0.06 - history[6000].crack->opening / 0.25; // strain at which the opening is used up
    int open = 0, closed = 0;
    for (std::size_t n = 6000; n < history.size(); ++n) {
        const PointState& state = history[n];
        if (state.strain[0] > contact + 1e-9) {
            ++open;
            EXPECT_NEAR(state.stress[0], 0, 1e-6);
        } else {
            ++closed;
            EXPECT_NEAR(state.stress[0], modulus * (state.strain[0] - contact), 1e-5 * 4000);
            EXPECT_NEAR(state.crack->opening, 0, 1e-9);
        }
    }
    EXPECT_GT(open, 100);
    EXPECT_GT(closed, 50);
    EXPECT_LT(history.back().stress[0], -500);
    EXPECT_EQ(history.back().decohesion_work, history[6000].decohesion_work);
}

/// Beyond snap-back the tractions fall in time, at constant strain: step_time counts.
TEST(Point, brittle_drop_takes_eight_transits)
{
    material::Material material = breaking_steel();
    material.decohesion->energy_1 = 0.5;
    material.decohesion->snap_back = material::SnapBack::brittle_drop;
    const PointState end = followed(material, {uniaxial_strain(60000, 0.06)}).back();
    ASSERT_TRUE(end.crack);
    EXPECT_GT(end.crack->snap_back_ratio, 10);
    EXPECT_NEAR(end.crack->separation_time - end.crack->onset_time, 8 * 0.25 / material.elastic.wave_speed(), 2e-5);
    // What a strain held at the onset would release, plus what the strain goes on to add meanwhile.
    const Real strength = end.crack->normal_strength;
    EXPECT_NEAR(dissipated(end) / (0.5 * strength * strength / 262500 * 0.25), 1, 0.05);
}

std::string failure(const material::Material& material, const std::vector<PointSegment>& segments)
{
    try {
        (void)followed(material, segments);
    } catch (const core::NumericalError& error) {
        return error.what();
    }
    return "";
}

testing::AssertionResult contains(const std::string& text, const std::string& part)
{
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "expected\n" << part << "\nin\n" << text;
}

// H / (3 mu + H) in shear whatever the plastic strain: bifurcation comes with perfect plasticity, not before.
TEST(Point, hardening_keeps_the_acoustic_tensor_regular)
{
    const Real shear_three = 3 * steel().elastic.shear_modulus();
    for (const Real tangent : {1150.0, 0.0}) {
        const Real hardening = material::VonMises{1100, tangent}.plastic_modulus(195e3);
        const PointSegment shear{400, Strains{0, 0, 0, 0.3, 0, 0}};
        for (const PointState& state : followed(plastic_steel(tangent), {shear}))
            EXPECT_NEAR(state.acoustic_ratio, state.eq_plastic_strain > 0 ? hardening / (shear_three + hardening) : 1,
                        1e-9);
        const PointState pulled = followed(plastic_steel(tangent), {uniaxial_strain(400, 0.3)}).back();
        EXPECT_GT(pulled.acoustic_ratio, 0.2);
    }
}

TEST(Point, perfect_plasticity_has_no_stress_beyond_yield)
{
    const std::string text = failure(plastic_steel(0), {{12, {}, core::Sym<Real>{{1200, 0, 0, 0, 0, 0}}}});
    EXPECT_TRUE(contains(text, "no strain gives stress xx = 1200 MPa at step 12; the closest found is "));
    EXPECT_TRUE(contains(text, "prescribe a strain"));
}

TEST(Point, softening_under_stress_control_says_so)
{
    PointSegment pull{100, Strains{free_component, 0, 0, 0, 0, 0}, core::Sym<Real>{{5000, 0, 0, 0, 0, 0}}};
    const std::string text = failure(breaking_steel(), {pull});
    EXPECT_TRUE(contains(text, "no strain gives stress xx = 5000 MPa at step 100; the closest found is 4950 MPa"));
    EXPECT_TRUE(contains(text, "the point softens (damage 0), and softening under prescribed stress has no solution"));
    pull.stress[0] = 100; // and a crack that is through
    EXPECT_TRUE(contains(failure(breaking_steel(), {uniaxial_strain(6000, 0.06), pull}),
                         "no strain gives stress xx = 1 MPa at step 6001; the closest found is 0 MPa\n"
                         "the crack is through and carries no tension"));
}
} // namespace
} // namespace solver
