// Failures of docs/failures.md by their case files: how far they reach, and what stays clear of them.
#include "tests/support/case_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
support::Results prestressed_block(const std::vector<std::string>& overrides)
{
    return support::results_of("failures/prestressed-block.toml", overrides);
}
} // namespace

/// Transfers that damp short waves keep a body under large elastic strain at rest. (Motion on the nodes bursts it.)
TEST(Failures, damped_transfers_keep_a_prestressed_block_at_rest)
{
    for (const char* transfer : {"numerics.transfer=flip", "numerics.transfer=apic"}) {
        const support::Results results = prestressed_block({transfer, "end.time=1600"});
        EXPECT_LT(results.at("kinetic_mJ"), 1e-8 * results.at("elastic_mJ")) << transfer;
    }
}

/// Steel at its yield stress, motion on the nodes: what the start left does not grow in the time of a challenge run.
TEST(Failures, prestressed_metal_stays_at_rest)
{
    const auto steel = [](const char* from, const char* until) {
        return prestressed_block({"material.rubbery.youngs_modulus=195000", "material.rubbery.poisson_ratio=0.3",
                                  "material.rubbery.density=7.81e-3", "load.top.pressure=-1100",
                                  "load.top.ramp.time=0.004", std::string("measure.0.from=") + from,
                                  std::string("end.time=") + until, "output.history.every_time=0.005"});
    };
    EXPECT_LT(steel("0.6", "0.8").at("kinetic_mJ"), 1.3 * steel("0.1", "0.3").at("kinetic_mJ"));
}

/// B15: at 0.95 of the strength nothing may crack; particles that cross cells make noise enough to start it.
TEST(Failures, noise_of_crossings_starts_cracks_and_boxes_do_not)
{
    const auto first_crack = [](std::vector<std::string> overrides) {
        overrides.emplace_back("end.time=20"); // two periods
        return support::results_of("failures/noise-onset.toml", overrides).at("first_crack_ms");
    };
    EXPECT_TRUE(std::isnan(first_crack({})));
    EXPECT_TRUE(std::isnan(first_crack({"numerics.transfer=flip"})));
    EXPECT_TRUE(std::isnan(first_crack({"numerics.formulation=updated", "numerics.basis=gimp"})));
    EXPECT_LT(first_crack({"numerics.formulation=updated"}), 2.5);
}

/// B28: torn to twelve cells, the crack's particles stay with the fragments and keep the energy of the crack.
TEST(Failures, what_has_torn_does_not_run_away)
{
    for (const std::vector<std::string>& scheme :
         {std::vector<std::string>{}, {"numerics.transfer=flip"}, {"numerics.formulation=updated"}})
    {
        const support::Results results = support::results_of("failures/fragments.toml", scheme);
        EXPECT_LT(results.at("fastest"), 2.2 * 5);
        EXPECT_NEAR(results.at("crack_energy_mJ") / 0.25, 1, 2e-3);
    }
}

/// B27: across an interface of levels a crack dissipates up to a tenth more than its fracture energy.
TEST(Failures, a_crack_that_leaves_the_fine_cells_dissipates_a_little_more)
{
    const Real energy = support::results_of("fracture/two-level.toml", {"end.time=0.3"}).at("crack_energy_mJ");
    EXPECT_GT(energy, 2);
    EXPECT_LT(energy, 2.2);
}

/// B2: what the grid does not see FLIP keeps; APIC, a little PIC and motion on the nodes do not.
TEST(Failures, hidden_modes_stay_in_flip_only)
{
    const auto kept = [](const std::vector<std::string>& overrides) {
        return support::results_of("failures/hidden-modes.toml", overrides).at("energy_kept");
    };
    EXPECT_GT(kept({}), 0.9);
    EXPECT_GT(kept({"numerics.basis=gimp"}), 0.9);
    EXPECT_LT(kept({"numerics.pic_fraction=0.01"}), 0.01);
    EXPECT_LT(kept({"numerics.transfer=apic"}), 0.05); // what the ends see stays, rightly
    EXPECT_LT(kept({"numerics.formulation=total", "numerics.stress_update=usl", "numerics.transfer=nodal"}), 0.05);
}

/// B3: drift feeds a vibration in the updated formulation; APIC boxes keep it within a small factor, the total one does
/// not see it.
TEST(Failures, drift_feeds_a_vibration)
{
    const auto largest = [](const std::vector<std::string>& overrides) {
        return support::results_of("failures/drift.toml", overrides).at("largest_elastic");
    };
    EXPECT_GT(largest({}), 1000);
    EXPECT_GT(largest({"numerics.basis=gimp"}), 1000);
    EXPECT_LT(largest({"numerics.basis=gimp", "numerics.transfer=apic"}), 2);
    EXPECT_LT(largest({"numerics.formulation=total", "numerics.stress_update=usl"}), 1.05);
}

/// B4: a particle that enters an empty cell gives its far nodes almost no mass; with the stress last that bursts.
TEST(Failures, small_masses_burst_points_with_the_stress_last)
{
    const auto largest = [](const std::vector<std::string>& overrides) {
        std::vector<std::string> early = overrides;
        early.insert(early.end(), {"end.time=30", "measure.0.from=0"}); // 30 cells of drift, before B3 shows
        return support::results_of("failures/drift.toml", early).at("largest_elastic");
    };
    EXPECT_GT(largest({"numerics.stress_update=usl"}), 1000);
    EXPECT_LT(largest({}), 1.05);
    EXPECT_LT(largest({"numerics.stress_update=usl", "numerics.basis=gimp"}), 1.05);
}

/// B6: PIC loses exp(-3/16 (k h)^2) of the energy a step: each of its two maps takes 3/32 (k h)^2 off the velocity
/// where the particles sit at 1/4 and 3/4 of a cell.
TEST(Failures, pic_dissipates_as_its_closed_form_says)
{
    const auto kept = [](const std::vector<std::string>& overrides) {
        return support::results_of("verification/c5-bar/case.toml", overrides).at("energy_kept");
    };
    const Real k_h = 2 * std::numbers::pi / 128, steps = 2560;
    EXPECT_NEAR(kept({"numerics.transfer=flip", "numerics.pic_fraction=1"}), std::exp(-3.0 / 16 * k_h * k_h * steps),
                0.002);
    EXPECT_NEAR(kept({"numerics.transfer=flip"}), 1, 0.002);
    EXPECT_NEAR(kept({"numerics.transfer=apic"}), 1, 0.002);
}

/// B7: particles that move apart lose the stress; boxes with an affine velocity hold it longest, the total formulation
/// for good.
TEST(Failures, stretching_tears_points_and_not_the_total_formulation)
{
    const auto stress = [](const std::vector<std::string>& overrides) {
        return support::results_of("failures/stretch.toml", overrides);
    };
    EXPECT_LT(stress({}).at("lowest_stress"), 0.85);
    EXPECT_LT(stress({"numerics.basis=gimp"}).at("lowest_stress"), 0.9);
    const std::vector<std::string> cures[] = {{"numerics.basis=gimp", "numerics.transfer=apic"},
                                              {"numerics.formulation=total", "numerics.stress_update=usl"}};
    for (const auto& cure : cures) {
        EXPECT_NEAR(stress(cure).at("lowest_stress"), 1, 0.015);
        EXPECT_NEAR(stress(cure).at("highest_stress"), 1, 0.015);
    }
}

/// B9: energy of a bar whose end crosses cells and a level interface, over five periods; with the stress last over ten,
/// since its noise takes over in the seventh.
TEST(Failures, swinging_keeps_its_energy_with_boxes_and_in_the_total_formulation)
{
    const auto kept = [](const char* end, const std::vector<std::string>& overrides) {
        std::vector<std::string> all = overrides;
        all.emplace_back(end);
        return support::results_of("failures/swing.toml", all).at("energy_kept");
    };
    EXPECT_NEAR(kept("end.time=64", {}), 1, 0.005);
    EXPECT_NEAR(kept("end.time=64", {"numerics.formulation=total", "numerics.basis=trilinear"}), 1, 0.001);
    EXPECT_LT(kept("end.time=128", {"numerics.stress_update=usl"}), 0.5);
    EXPECT_GT(kept("end.time=64", {"numerics.basis=trilinear"}), 1.1);
}

/// B24: particles that swing across an interface are split once, in the first period, and never again.
TEST(Failures, particles_that_swing_across_an_interface_are_split_once)
{
    support::Job run =
        support::started(io::read_case(std::string(CLEAVE_SOURCE_DIR) + "/cases/failures/swing.toml", {}));
    const auto count_at = [&](Real time) {
        while (run.state.clock.time < time) support::advance(1, run);
        return run.state.particles.size();
    };
    const std::size_t start = run.state.particles.size(), first_period = count_at(12.8);
    EXPECT_GT(first_period, start);
    EXPECT_EQ(count_at(64), first_period);
}

/// B26: one particle per cell does not feel bending.
TEST(Failures, one_particle_per_cell_does_not_feel_bending)
{
    const auto deflection = [](const std::vector<std::string>& overrides) {
        return 3 * support::results_of("failures/hourglass.toml", overrides).at("deflection_mm");
    };
    EXPECT_GT(deflection({"grid.particles_per_cell=1"}), 1.9);
    EXPECT_NEAR(deflection({}), 1, 0.2);
    EXPECT_NEAR(deflection({"grid.cell=0.5"}), 1, 0.02);
}

/// B30: bodies meet three quarters of a cell too early.
TEST(Failures, contact_comes_a_part_of_a_cell_too_early)
{
    const auto gap = [](const char* cell, Real spacing) {
        return support::results_of("failures/contact.toml", {cell}).at("nearest_mm") - spacing / 2;
    };
    EXPECT_NEAR(gap("grid.cell=1", 1), 0.73, 0.05);
    EXPECT_NEAR(gap("grid.cell=0.5", 0.5), 0.56, 0.05);
}
