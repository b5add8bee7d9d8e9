/// io/point_case.h: cases of a material point, their mistakes, and cases of the other kind.
#include "io/point_case.h"

#include "case_file.h"
#include "io/point_file.h"

#include <algorithm>

namespace
{
using test::with;

constexpr std::string_view valid_point = R"(units = "mm-g-ms"
title = "a path"
[material.steel]
density = "7.81e-3 g/mm^3"
youngs_modulus = "195 GPa"
poisson_ratio = 0.3
[point]
material = "steel"
cell = "0.25 mm"
[[point.segment]]
steps = 20
strain = { xx = 0.01, yz = -0.002 }
stress = { yy = "1 GPa" }
[[point.segment]]
steps = 5
rotation = [0, 0, 0.5]
)";

class PointCase : public test::CaseFile
{
protected:
    std::string point_complaint(std::string_view text) const
    {
        try {
            (void)io::read_point_case(write(text));
        } catch (const core::InputError& error) {
            std::string out = error.what();
            const std::string prefix = directory().string() + "/";
            for (std::size_t at = out.find(prefix); at != std::string::npos; at = out.find(prefix))
                out.erase(at, prefix.size());
            return out;
        }
        return "";
    }
};

TEST_F(PointCase, values_arrive)
{
    const io::PointCase read = io::read_point_case(write(valid_point));
    EXPECT_EQ(read.title, "a path");
    EXPECT_EQ(read.path.material.name, "steel");
    EXPECT_EQ(read.path.spacing, 0.25);
    EXPECT_NEAR(read.path.step_time, 0.125 / read.path.material.elastic.wave_speed(), 1e-15);
    ASSERT_EQ(read.path.segments.size(), 2U);
    const solver::PointSegment& first = read.path.segments[0];
    EXPECT_EQ(first.steps, 20);
    EXPECT_EQ(first.strain[0], 0.01);
    EXPECT_EQ(first.strain[4], -0.002);
    for (const std::size_t i : {1U, 2U, 3U, 5U}) EXPECT_FALSE(first.strain[i]) << i;
    EXPECT_EQ(first.stress.s, (std::array<Real, 6>{0, 1000, 0, 0, 0, 0}));
    EXPECT_EQ(read.path.segments[1].rotation.v, (std::array<Real, 3>{0, 0, 0.5}));
}

TEST_F(PointCase, resolved_text_gives_the_same_case)
{
    const io::PointCase first = io::read_point_case(write(valid_point), {"point.segment.1.steps=7"});
    EXPECT_EQ(first.path.segments[1].steps, 7);
    const io::PointCase second = io::read_point_case(write(first.resolved, "resolved.toml"));
    EXPECT_EQ(second.resolved, first.resolved);
    EXPECT_EQ(second.path.step_time, first.path.step_time);
    EXPECT_EQ(second.path.segments[0].stress.s, first.path.segments[0].stress.s);
    EXPECT_EQ(second.path.segments[0].strain, first.path.segments[0].strain);
}

TEST_F(PointCase, unknown_component)
{
    EXPECT_EQ(point_complaint(with(valid_point, "yz = -0.002", "xz = -0.002")),
              "case.toml:12:23: error: unknown key 'xz' in [point.segment.strain]\n"
              "   12 | strain = { xx = 0.01, xz = -0.002 }\n"
              "      |                       ^~  did you mean 'xx'?\n"
              "   keys here: xx, xy, yy, yz, zx, zz     (cleave keys point.segment.strain)\n"
              "1 error");
}

TEST_F(PointCase, wrong_units)
{
    EXPECT_EQ(point_complaint(with(valid_point, "\"1 GPa\"", "\"1 mm\"")),
              "case.toml:13:17: error: '1 mm' is a length, but 'yy' is a stress\n"
              "   13 | stress = { yy = \"1 mm\" }\n"
              "      |                 ^~~~~~  expected stress [MPa], such as \"195 GPa\"\n"
              "1 error");
}

TEST_F(PointCase, component_prescribed_twice)
{
    EXPECT_EQ(point_complaint(with(valid_point, "{ yy =", "{ xx =")),
              "case.toml:13:17: error: strain and stress of component 'xx' are both prescribed\n"
              "   13 | stress = { xx = \"1 GPa\" }\n"
              "      |                 ^~~~~~~  give one of them\n"
              "1 error");
}

TEST_F(PointCase, every_mistake_at_once)
{
    std::string text = with(valid_point, "material = \"steel\"", "material = \"steal\"");
    text = with(text, "steps = 20", "steps = 0");
    text = with(text, "steps = 5", "");
    text = with(text, "[point]", "[grid]\ncell = 1\n[point]");
    const std::string complaint = point_complaint(text);
    for (const std::string part :
         {"case.toml:7:1: error: a case with [point] has no 'grid'\n", "there is no material 'steal'\n",
          "did you mean 'steel'?", "case.toml:13:9: error: 'steps' is out of range: 0\n",
          "case.toml:16:1: error: missing key 'steps' in [point.segment]\n", "4 errors"})
        EXPECT_NE(complaint.find(part), std::string::npos) << part << "\nin\n" << complaint;
}

TEST_F(PointCase, path_is_needed)
{
    const std::string text(valid_point.substr(0, valid_point.find("[[point.segment]]")));
    EXPECT_NE(point_complaint(text).find("the point has no path"), std::string::npos) << point_complaint(text);
    EXPECT_NE(point_complaint(text + "segment = { steps = 1 }\n").find("'point.segment' must be an array of tables"),
              std::string::npos);
}

TEST_F(PointCase, each_kind_of_case_names_the_command_of_the_other)
{
    EXPECT_EQ(complaint(valid_point), "case.toml:7:1: error: [point] makes this the case of a material point\n"
                                      "    7 | [point]\n"
                                      "      | ^~~~~~~  use `cleave point`\n"
                                      "1 error");
    EXPECT_NE(point_complaint(test::valid_case).find("the case has no [point]"), std::string::npos);
    EXPECT_NE(point_complaint(test::valid_case).find("`cleave run` runs cases with bodies"), std::string::npos);
}

TEST_F(PointCase, cases_of_the_repository_are_valid)
{
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CLEAVE_SOURCE_DIR "/cases/point")) {
        if (entry.path().extension() != ".toml" || entry.path().stem() == "steel") continue;
        ++count;
        EXPECT_NO_THROW((void)io::read_point_case(entry.path())) << entry.path();
        if (entry.path().stem() == "snap-back" || entry.path().stem() == "willam") continue; // one material
        EXPECT_NO_THROW((void)io::read_point_case(entry.path(), {"point.material=paper"})) << entry.path();
    }
    EXPECT_EQ(count, 6);
}

TEST(PointFile, has_a_value_for_every_column)
{
    solver::PointState state;
    state.step = 3;
    state.stress = {{0, 5, 0, 2, 0, 0}};
    state.decohesion_work = 4;
    state.crack = core::Crack{};
    state.crack->normal = {0, 1, 0};
    state.crack->effective_length = 0.5;
    const std::string text = io::point_csv({solver::PointState{}, state});
    std::array<std::ptrdiff_t, 3> commas{};
    std::size_t from = 0;
    for (std::ptrdiff_t& count : commas) {
        const std::size_t end = text.find('\n', from);
        count = std::count(text.begin() + static_cast<std::ptrdiff_t>(from),
                           text.begin() + static_cast<std::ptrdiff_t>(end), ',');
        from = end + 1;
    }
    EXPECT_EQ(from, text.size());
    EXPECT_EQ(commas[1], commas[0]);
    EXPECT_EQ(commas[2], commas[0]);
    EXPECT_TRUE(text.ends_with(",0,1,0,5,2,0,4,2,1\n")) << text; // normal, tractions, works, acoustic ratio
}
} // namespace
