/// `cleave point` as a user runs it, with the numbers cases/point/README.md promises.
#include "tests/regression/program.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace fs = std::filesystem;

namespace
{
const std::string cases = std::string(CLEAVE_SOURCE_DIR) + "/cases/point/";

testing::AssertionResult contains(const std::string& text, const std::string& part)
{
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "expected\n" << part << "\nin\n" << text;
}

TEST(PointCommand, opening_writes_its_files_and_its_summary)
{
    const support::Folder folder;
    const fs::path directory = folder / "out";
    const test::Outcome outcome = test::run({"point", cases + "opening.toml", "-o", directory.string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_EQ(test::files_below(directory), (std::vector<std::string>{"point.csv", "point.svg", "resolved.toml"}));
    EXPECT_TRUE(contains(outcome.output, "mode opening\n"));
    EXPECT_TRUE(contains(outcome.output, "policy       energy floor, not needed"));
    const std::string csv = test::contents(directory / "point.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6002); // header, state 0, 6000 steps
    const std::string svg = test::contents(directory / "point.svg");
    EXPECT_TRUE(contains(svg, "normal over opening"));
    // The same path again, from the resolved case and over the old files.
    const test::Outcome again = test::run({"point", (directory / "resolved.toml").string(), "-o", directory.string()});
    EXPECT_EQ(again.exit_code, 0) << again.output;
    EXPECT_EQ(test::contents(directory / "point.csv"), csv);
}

TEST(PointCommand, paper_preset_drops)
{
    const support::Folder folder;
    const test::Outcome outcome =
        test::run({"point", cases + "shear.toml", "--set", "point.material=paper", "-o", folder.path().string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_TRUE(contains(outcome.output, "mode shear\n"));
    EXPECT_TRUE(contains(outcome.output, "policy       brittle drop over 8 transits"));
}

TEST(PointCommand, keeps_what_it_computed_before_a_failure)
{
    const support::Folder folder;
    const fs::path directory = folder / "out", file = folder / "tension.toml";
    std::ofstream(file) << "include = \"" << cases << "steel.toml\"\n[point]\nmaterial = \"objective\"\ncell = 0.25\n"
                        << "[[point.segment]]\nsteps = 3000\nstress = { xx = 3000 }\n"; // shears at 1640 MPa
    const test::Outcome outcome = test::run({"point", file.string(), "-o", directory.string()});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
    EXPECT_TRUE(contains(outcome.output, "no strain gives stress xx"));
    const std::string csv = test::contents(directory / "point.csv");
    EXPECT_GT(std::count(csv.begin(), csv.end(), '\n'), 1000);
}

/// Number that follows `label` in a summary.
double value_after(const std::string& text, const std::string& label)
{
    const std::size_t at = text.find(label);
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + label.size()));
}

/// B10: the table of the README, with the policy named.
TEST(PointCommand, snap_back_dissipates_the_energy_or_the_floor)
{
    const support::Folder folder;
    const struct
    {
        const char* cell;
        double energy;
    } table[] = {{"0.44", 0.137}, {"1.97", 0.147977}, {"2.41", 0.181027}, {"10.95", 0.82251}, {"26.3", 1.97553}};
    for (const auto& [cell, energy] : table) {
        const test::Outcome outcome = test::run({"point", cases + "snap-back.toml", "--set",
                                                 std::string("point.cell=") + cell, "-o", folder.path().string()});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
        EXPECT_NEAR(value_after(outcome.output, "dissipated   ") / energy, 1, 1e-3) << cell;
    }
}

/// B14: what a fixed plane locks, a plane that turns with the strain lets go.
TEST(PointCommand, willam_locks_with_a_fixed_plane)
{
    const support::Folder folder;
    const auto largest = [&](const char* rotating) {
        const test::Outcome outcome = test::run({"point", cases + "willam.toml", "--set",
                                                 std::string("material.concrete.decohesion.rotating_until=") + rotating,
                                                 "-o", folder.path().string()});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
        return value_after(outcome.output, "largest ");
    };
    EXPECT_NEAR(largest("0"), 14.81, 0.02);
    EXPECT_NEAR(largest("1"), 2.73, 0.02);
}

/// B14: the plane is chosen again where the stress reaches the strength by a twentieth more.
TEST(PointCommand, willam_does_not_lock_where_the_plane_is_renewed)
{
    const support::Folder folder;
    const auto largest = [&](const char* rotating) {
        const test::Outcome outcome = test::run(
            {"point", cases + "willam.toml", "--set", "material.concrete.decohesion.renewed_plane=true", "--set",
             std::string("material.concrete.decohesion.rotating_until=") + rotating, "-o", folder.path().string()});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
        return value_after(outcome.output, "largest ");
    };
    EXPECT_NEAR(largest("0"), 1.461, 0.005);
    EXPECT_NEAR(largest("1"), 1.120, 0.002);
}

/// B14: what one plane does not see, a second crack lets go as soon as the first one is through.
TEST(PointCommand, willam_breaks_across)
{
    const support::Folder folder;
    const test::Outcome outcome =
        test::run({"point", cases + "willam.toml", "--set", "material.concrete.decohesion.second_crack=true", "-o",
                   folder.path().string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_NEAR(value_after(outcome.output, "largest "), 1.834, 0.002);
    EXPECT_NEAR(value_after(outcome.output, "crossed by a second crack at t = "), 2.8364, 1e-3);
}

TEST(PointCommand, refuses_cases_and_directories_of_runs)
{
    const test::Outcome run_case = test::run({"point", std::string(CLEAVE_SOURCE_DIR) + "/cases/tension/coupon.toml"});
    EXPECT_EQ(run_case.exit_code, 2);
    EXPECT_TRUE(contains(run_case.output, "the case has no [point]"));
    const test::Outcome point_case = test::run({"run", cases + "opening.toml"});
    EXPECT_EQ(point_case.exit_code, 2);
    EXPECT_TRUE(contains(point_case.output, "use `cleave point`"));
    const support::Folder folder;
    std::ofstream(folder / "run.json") << "{}";
    const test::Outcome mixed = test::run({"point", cases + "opening.toml", "-o", folder.path().string()});
    EXPECT_EQ(mixed.exit_code, 2);
    EXPECT_TRUE(contains(mixed.output, "holds a run"));
}
} // namespace
