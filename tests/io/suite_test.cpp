#include "io/suite.h"

#include "io/keys.h"
#include "io/sweep.h"

#include "case_file.h"

#include <algorithm>

namespace
{
using test::valid_case;
using test::with;

constexpr std::string_view valid_suite = R"(title = "two scenes"
[[axis]]
name = "scheme"
[[axis.setting]]
label = "nodal"
[[axis.setting]]
label = "flip"
set = ["numerics.transfer=flip"]
[[axis]]
name = "cells"
resolution = true
[[axis.setting]]
label = "h"
[[axis.setting]]
label = "h/2"
set = ["grid.cell=0.5"]
[[scene]]
name = "plate"
case = "case.toml"
measure = "errors.u"
products = [["scheme", "cells"]]
[[scene]]
name = "own axis"
case = "case.toml"
measure = "measures.peak_force_N"
reference = 12.5
stable = { measure = "measures.energy_residual", below = 0.01 }
limit = "2 min"
products = [["cells"], ["scheme"]]
[[scene.axis]]
name = "cells"
[[scene.axis.setting]]
label = "h/4"
set = ["grid.cell=0.25"]
)";

constexpr std::string_view valid_sweep = R"(case = "case.toml"
threads = 2
set = ["end.cod=1"]
[[vary]]
key = "material.steel.decohesion.s_max"
values = ["3000 MPa", 4900]
[[vary]]
key = "grid.levels"
values = [1, 2]
[[target]]
measure = "peak_force_N"
value = 8449
weight = 2
)";

class Suite : public test::CaseFile
{
protected:
    Suite() { write(valid_case); }

    template <class Read>
    std::string complaint_of(std::string_view text, const Read& read)
    {
        try {
            (void)read(write(text, "study.toml"));
        } catch (const core::InputError& error) {
            std::string out = error.what();
            const std::string prefix = directory().string() + "/";
            for (std::size_t at = out.find(prefix); at != std::string::npos; at = out.find(prefix))
                out.erase(at, prefix.size());
            return out;
        }
        return "";
    }
    std::string suite_complaint(std::string_view text) { return complaint_of(text, io::read_suite); }
    std::string sweep_complaint(std::string_view text) { return complaint_of(text, io::read_sweep); }
};
using Sweep = Suite;

TEST_F(Suite, is_read)
{
    const io::Suite suite = io::read_suite(write(valid_suite, "study.toml"));
    EXPECT_EQ(suite.title, "two scenes");
    ASSERT_EQ(suite.scenes.size(), 2U);
    const io::Scene& plate = suite.scenes[0];
    EXPECT_EQ(plate.file, directory() / "case.toml");
    EXPECT_FALSE(plate.reference);
    EXPECT_EQ(plate.limit, 600);
    ASSERT_EQ(plate.products.size(), 1U);
    ASSERT_EQ(plate.products[0].size(), 2U);
    EXPECT_FALSE(plate.products[0][0].resolution);
    EXPECT_TRUE(plate.products[0][1].resolution);
    EXPECT_EQ(plate.products[0][1].settings[1].set, std::vector<std::string>{"grid.cell=0.5"});
    const io::Scene& own = suite.scenes[1];
    EXPECT_EQ(own.reference, 12.5);
    EXPECT_EQ(own.limit, 120);
    EXPECT_EQ(own.stable->below, 0.01);
    // The scene's axis stands for the shared one of the same name.
    ASSERT_EQ(own.products.size(), 2U);
    ASSERT_EQ(own.products[0][0].settings.size(), 1U);
    EXPECT_EQ(own.products[0][0].settings[0].label, "h/4");
    EXPECT_EQ(own.products[1][0].settings.size(), 2U);
}

TEST_F(Suite, says_where_an_axis_is_misspelt)
{
    EXPECT_EQ(suite_complaint(with(valid_suite, "[[\"scheme\", \"cells\"]]", "[[\"schema\", \"cells\"]]")),
              "study.toml:21:14: error: there is no axis 'schema'\n"
              "   21 | products = [[\"schema\", \"cells\"]]\n"
              "      |              ^~~~~~~~  did you mean 'scheme'?\n"
              "   axes here: scheme, cells\n"
              "1 error");
}

TEST_F(Suite, gathers_every_error)
{
    std::string text = with(valid_suite, "measure = \"errors.u\"", "mesure = \"errors.u\"");
    text = with(text, "case = \"case.toml\"", "case = \"cas.toml\"");
    text = with(text, "\"grid.cell=0.25\"", "\"grid.cell\"");
    text = with(text, "name = \"own axis\"", "name = \"plate\"");
    const std::string found = suite_complaint(text);
    for (const char* part :
         {"unknown key 'mesure' in [scene]", "did you mean 'measure'?", "there is no case file 'cas.toml'",
          "'grid.cell' is no override", "there are two scenes 'plate'", "missing key 'measure' in [scene]"})
        EXPECT_NE(found.find(part), std::string::npos) << part << "\nin\n" << found;
    EXPECT_NE(found.find("5 errors"), std::string::npos) << found;
}

TEST_F(Suite, unknown_keys_at_the_top_name_the_suite)
{
    const std::string found = suite_complaint(with(valid_suite, "title =", "titel ="));
    EXPECT_NE(found.find("unknown key 'titel' at the top of the file"), std::string::npos) << found;
    EXPECT_NE(found.find("(cleave keys suite)"), std::string::npos) << found;
}

TEST_F(Sweep, makes_every_combination)
{
    const io::Sweep sweep = io::read_sweep(write(valid_sweep, "study.toml"));
    EXPECT_EQ(sweep.threads, 2);
    ASSERT_EQ(sweep.runs.size(), 4U);
    EXPECT_EQ(sweep.runs[0].label, "s_max=3000 MPa levels=1");
    EXPECT_EQ(sweep.runs[1].label, "s_max=3000 MPa levels=2");
    EXPECT_EQ(sweep.runs[2].set, (std::vector<std::string>{"material.steel.decohesion.s_max=4900", "grid.levels=1"}));
    ASSERT_EQ(sweep.targets.size(), 1U);
    EXPECT_EQ(sweep.targets[0].weight, 2);
}

TEST_F(Sweep, takes_the_targets_of_a_reference)
{
    write(std::string(valid_case) + "[[reference]]\nname = \"experiment\"\npeak_force_N = 8449\nc1_cod_mm = 2.5\n");
    const std::string text = with(with(valid_sweep, "threads = 2", "reference = \"experiment\""), "value = 8449\n", "");
    const io::Sweep sweep = io::read_sweep(write(text, "study.toml"));
    ASSERT_EQ(sweep.targets.size(), 2U);
    EXPECT_EQ(sweep.targets[0].measure, "c1_cod_mm");
    EXPECT_EQ(sweep.targets[0].weight, 1);
    EXPECT_EQ(sweep.targets[1].value, 8449);
    EXPECT_EQ(sweep.targets[1].weight, 2);
    EXPECT_NE(sweep_complaint(with(text, "\"experiment\"", "\"experimant\"")).find("did you mean 'experiment'?"),
              std::string::npos);
}

TEST_F(Sweep, complains)
{
    EXPECT_NE(sweep_complaint(with(valid_sweep, "value = 8449\n", "")).find("target 'peak_force_N' has no value"),
              std::string::npos);
    EXPECT_NE(sweep_complaint(std::string(valid_sweep) + "[[run]]\nlabel = \"a\"\nset = []\n")
                  .find("a sweep has [[vary]] or [[run]], not both"),
              std::string::npos);
    EXPECT_NE(sweep_complaint("case = \"case.toml\"\n").find("the sweep has no runs"), std::string::npos);
}

// Here and once, not in every run under the name of an override.
TEST_F(Sweep, says_where_a_name_is_misspelt)
{
    EXPECT_EQ(sweep_complaint(with(valid_sweep, "\"grid.levels\"", "\"grid.levls\"")),
              "study.toml:8:7: error: unknown key 'levls' in [grid]\n"
              "    8 | key = \"grid.levls\"\n"
              "      |       ^~~~~~~~~~~~  did you mean 'levels'?\n"
              "   keys here: cell, edge, levels, origin, particles_per_cell     (cleave keys grid)\n"
              "1 error");
    const auto expect = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
        EXPECT_TRUE(text.ends_with("\n1 error")) << text;
    };
    expect(sweep_complaint(with(valid_sweep, "\"end.cod=1\"", "\"end.cood=1\"")),
           "study.toml:3:8: error: unknown key 'cood' in [end]\n");
    expect(sweep_complaint(with(valid_sweep, "material.steel", "material.stel")),
           "study.toml:5:7: error: there is no material 'stel'\n");
    expect(sweep_complaint("case = \"case.toml\"\n[[run]]\nlabel = \"a\"\nset = [\"load.bse.velocity=1\"]\n"),
           "study.toml:4:8: error: there is no load 'bse'\n");
    expect(sweep_complaint(with(valid_sweep, "\"peak_force_N\"", "\"peak_force\"")),
           "study.toml:11:11: error: the runs have no measure 'peak_force'\n"
           "   11 | measure = \"peak_force\"\n"
           "      |           ^~~~~~~~~~~~  did you mean 'peak_force_N'?\n"
           "   measures: peak_force_N, ");
}

TEST(StudyFiles, of_the_cases_can_be_read)
{
    const std::filesystem::path cases = std::filesystem::path(CLEAVE_SOURCE_DIR) / "cases";
    for (const char* name : {"quick.toml", "full.toml"})
        EXPECT_GE(io::read_suite(cases / "chart" / name).scenes.size(), 1U) << name;
    for (const auto& entry : std::filesystem::directory_iterator(cases / "sweep"))
        EXPECT_GE(io::read_sweep(entry.path()).runs.size(), 2U) << entry.path();
}

TEST(StudyKeys, are_unique_and_explained)
{
    std::vector<std::string> seen;
    for (const io::Key& key : io::study_keys()) {
        const std::string name = std::string(key.section) + "/" + std::string(key.name);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), name), 0) << name;
        seen.push_back(name);
        EXPECT_FALSE(key.meaning.empty()) << name;
        EXPECT_EQ(key.presence == io::Presence::defaulted, !key.fallback.empty()) << name;
    }
}
} // namespace
