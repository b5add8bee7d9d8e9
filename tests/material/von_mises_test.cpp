/// material/von_mises.h and elastic.h: yield surface, work, invariances, lanes against scalar.
#include "material/von_mises.h"

#include "tests/material/samples.h"

#include <gtest/gtest.h>

namespace material
{
TEST(VonMises, lands_on_the_yield_surface_and_keeps_pressure_and_direction)
{
    const auto constants = plastic_constants<double>(steel(), steel_plastic());
    Samples samples;
    int flowing = 0;
    for (int k = 0; k < 200; ++k) {
        const Sym trial = samples.tensor(900);
        const double strain = samples.uniform(0, 0.5);
        const double strength = constants.yield + constants.hardening * strain;
        const auto step = radial_return(trial, strain, constants);
        EXPECT_NEAR(core::trace(step.stress), core::trace(trial), 1e-10);
        if (equivalent(trial) <= strength) {
            for (int i = 0; i < 6; ++i) EXPECT_NEAR(step.stress[i], trial[i], 1e-12 * 900);
            EXPECT_EQ(step.eq_plastic_strain, strain);
            EXPECT_EQ(step.work, 0);
            continue;
        }
        ++flowing;
        const double grown = constants.yield + constants.hardening * step.eq_plastic_strain;
        EXPECT_NEAR(equivalent(step.stress) / grown, 1, 1e-13);
        EXPECT_GT(step.eq_plastic_strain, strain);
        // Radial: the shear components shrink by the same factor.
        const double scale = equivalent(step.stress) / equivalent(trial);
        for (int i = 3; i < 6; ++i) EXPECT_NEAR(step.stress[i], scale * trial[i], 1e-11);
    }
    EXPECT_GT(flowing, 50);
}

TEST(VonMises, survives_zero_stress)
{
    const auto step = radial_return(Sym{}, 0.0, plastic_constants<double>(steel(), steel_plastic()));
    for (int i = 0; i < 6; ++i) EXPECT_EQ(step.stress[i], 0);
    EXPECT_EQ(step.eq_plastic_strain, 0);
}

TEST(VonMises, has_the_tangent_modulus_of_the_case_in_uniaxial_stress)
{
    // Along the hardening line d_sigma / d_eps = E_T; eps = sigma / E + eps_p (E_T read as tangent modulus).
    const VonMises plastic = steel_plastic();
    const double young = steel().youngs_modulus, hardening = plastic.plastic_modulus(young);
    EXPECT_NEAR(hardening, 1156.8, 0.05); // methods.md D.2, item 10
    EXPECT_NEAR(1 / (1 / young + 1 / hardening), plastic.tangent_modulus, 1e-9);
}

TEST(VonMises, work_depends_on_the_plastic_strain_alone)
{
    const auto constants = plastic_constants<double>(steel(), steel_plastic());
    const auto lame = lame_constants<double>(steel());
    Samples samples;
    PlasticStep<double> state{Sym{}, 0, 0};
    double work = 0, stress_work = 0;
    for (int k = 0; k < 400; ++k) {
        const Sym strain = (k < 200 ? 1.0 : -1.0) * Sym{{2e-4, -1e-4, -1e-4, 1e-4, 0, 5e-5}};
        const Sym before = state.stress;
        state = radial_return(elastic_trial(before, strain, lame), state.eq_plastic_strain, constants);
        work += state.work;
        stress_work += core::contract(0.5 * (before + state.stress), strain);
    }
    const double strain = state.eq_plastic_strain;
    EXPECT_GT(strain, 0.02);
    const double closed_form = constants.yield * strain + 0.5 * constants.hardening * strain * strain;
    EXPECT_NEAR(work / closed_form, 1, 1e-12);
    // What the stress did was stored or dissipated; the steps across the yield point cost second order.
    EXPECT_NEAR((stress_work - elastic_energy(steel(), state.stress)) / work, 1, 2e-3);
}

TEST(VonMises, is_objective)
{
    const auto constants = plastic_constants<double>(steel(), steel_plastic());
    Samples samples;
    for (int k = 0; k < 20; ++k) {
        const Mat r = samples.rotation();
        const Sym trial = samples.tensor(1500);
        const Sym one = core::rotated(r, radial_return(trial, 0.1, constants).stress);
        const Sym other = radial_return(core::rotated(r, trial), 0.1, constants).stress;
        EXPECT_LT(norm(one - other), 1e-10);
    }
}

template <class T>
void expect_lanes_like_scalar(double tolerance)
{
    using Lanes = core::Pack<T, core::native_lanes<T>>;
    const auto constants = plastic_constants<double>(steel(), steel_plastic());
    const auto lane_constants = plastic_constants<Lanes>(steel(), steel_plastic());
    Samples samples;
    for (int k = 0; k < 50; ++k) {
        core::Sym<Lanes> trial{};
        std::array<Sym, Lanes::lanes> trials;
        for (int lane = 0; lane < Lanes::lanes; ++lane) {
            trials[static_cast<std::size_t>(lane)] = samples.tensor(1000);
            for (int i = 0; i < 6; ++i) trial[i].v[lane] = static_cast<T>(trials[static_cast<std::size_t>(lane)][i]);
        }
        const auto step = radial_return(trial, Lanes(0.01), lane_constants);
        for (int lane = 0; lane < Lanes::lanes; ++lane) {
            const auto expected = radial_return(trials[static_cast<std::size_t>(lane)], 0.01, constants);
            for (int i = 0; i < 6; ++i) EXPECT_NEAR(step.stress[i][lane], expected.stress[i], tolerance * 1000);
            EXPECT_NEAR(step.eq_plastic_strain[lane], expected.eq_plastic_strain, tolerance);
            EXPECT_NEAR(step.work[lane], expected.work, tolerance * 1000);
        }
    }
}

TEST(VonMises, an_elastic_lane_keeps_its_bits_beside_one_that_yields)
{
    using Lanes = core::Pack<double, core::native_lanes<double>>;
    const auto constants = plastic_constants<Lanes>(steel(), steel_plastic());
    Samples samples;
    for (int k = 0; k < 20; ++k) {
        core::Sym<Lanes> trial{};
        for (int lane = 0; lane < Lanes::lanes; ++lane) {
            const Sym stress = samples.tensor(lane == 0 ? 2000 : 50);
            for (int i = 0; i < 6; ++i) trial[i].v[lane] = stress[i];
        }
        const auto step = radial_return(trial, Lanes(0.01), constants);
        EXPECT_GT(step.work[0], 0);
        for (int lane = 1; lane < Lanes::lanes; ++lane) {
            for (int i = 0; i < 6; ++i) EXPECT_EQ(step.stress[i][lane], trial[i][lane]);
            EXPECT_EQ(step.eq_plastic_strain[lane], 0.01);
            EXPECT_EQ(step.work[lane], 0);
        }
    }
}

TEST(VonMises, double_lanes_agree_with_scalar)
{
    expect_lanes_like_scalar<double>(1e-15);
}
TEST(VonMises, float_lanes_agree_with_scalar)
{
    expect_lanes_like_scalar<float>(1e-6);
}

TEST(Elastic, has_the_moduli_and_speed_of_the_paper_s_steel)
{
    const Elastic elastic = steel(); // methods.md Appendix 1
    EXPECT_NEAR(elastic.wave_modulus(), 262500, 1e-6);
    EXPECT_NEAR(elastic.shear_modulus(), 75000, 1e-6);
    EXPECT_NEAR(elastic.lame(), 112500, 1e-6);
    EXPECT_NEAR(elastic.wave_speed(), 5797.5, 0.1);
}

TEST(Elastic, stored_energy_is_the_work_of_a_straight_path)
{
    Samples samples;
    const Sym strain = samples.tensor(1e-3);
    const Sym stress = elastic_trial(Sym{}, strain, lame_constants<double>(steel()));
    EXPECT_NEAR(elastic_energy(steel(), stress) / (0.5 * core::contract(stress, strain)), 1, 1e-13);
}
} // namespace material
