#include "app/svg_chart.h"
#include "app/svg_field.h"
#include "tests/io/file_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
/// Are the tags of an XML text balanced and its attribute values quoted? Returns the first offending tag.
std::string unbalanced_tag(const std::string& xml)
{
    std::vector<std::string> open;
    for (std::size_t at = xml.find('<'); at != xml.npos; at = xml.find('<', at + 1)) {
        const std::size_t end = xml.find('>', at);
        const std::string tag = xml.substr(at + 1, end - at - 1);
        const std::string name =
            tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /", 1) - (tag[0] == '/' ? 1 : 0));
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0 || tag.find('<') != tag.npos) return tag;
        if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return tag;
            open.pop_back();
        } else if (tag.back() != '/')
            open.push_back(name);
    }
    return open.empty() ? "" : open.back();
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
    return n;
}
} // namespace

TEST(RoundTicks, AreRoundAndInside)
{
    EXPECT_EQ(app::round_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(app::round_ticks(-0.4, 1.1, 3), (std::vector<double>{0, 0.5, 1}));
    EXPECT_EQ(app::round_ticks(0, 8500, 6).back(), 8000);
}

TEST(SvgChart, DrawsLinesAndPointsAndSkipsWhatIsNoNumber)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    app::Chart chart{"x [mm]", "y <N>", {}};
    chart.series.push_back({"run", "red", app::ChartSeries::Mark::line, {0, 1, 2, 3, 4}, {0, 5, nan, 5, 2}});
    chart.series.push_back({"ref", "blue", app::ChartSeries::Mark::points, {1, 2}, {4, nan}, {"c1", "c2"}});
    const std::string svg = app::svg_chart(chart);
    EXPECT_EQ(unbalanced_tag(svg), "");
    EXPECT_PRED2(faults::contains, svg, "y &lt;N&gt;");
    EXPECT_EQ(count(svg, "<circle"), 1u);
    EXPECT_PRED2(faults::contains, svg, ">c1<");
    EXPECT_FALSE(faults::contains(svg, "nan"));
    const std::size_t line = svg.find("stroke=\"red\"");
    const std::string path = svg.substr(svg.rfind("<path", line), line - svg.rfind("<path", line));
    EXPECT_EQ(count(path, "M"), 2u); // the gap lifts the pen
    EXPECT_EQ(count(path, "L"), 2u);
}

TEST(SvgChart, SurvivesAnEmptyHistory)
{
    const std::string svg = app::svg_chart({"x", "y", {{"run", "red", app::ChartSeries::Mark::line, {}, {}}}});
    EXPECT_EQ(unbalanced_tag(svg), "");
    EXPECT_FALSE(faults::contains(svg, "inf"));
    EXPECT_FALSE(faults::contains(svg, "nan"));
}

TEST(SvgChart, StacksCharts)
{
    const auto chart = [](const char* label) {
        return app::Chart{"x", "y", {{label, "red", app::ChartSeries::Mark::line, {0, 1}, {0, 1}}}};
    };
    const std::string svg = app::svg_charts({chart("upper"), chart("lower")});
    EXPECT_EQ(unbalanced_tag(svg), "");
    EXPECT_EQ(count(svg, "<svg"), 1u);
    EXPECT_PRED2(faults::contains, svg, "viewBox=\"0 0 860 840\"");
    EXPECT_PRED2(faults::contains, svg, "translate(0 420)");
    EXPECT_LT(svg.find(">upper<"), svg.find("translate(0 420)"));
    EXPECT_GT(svg.find(">lower<"), svg.find("translate(0 420)"));
}

TEST(SvgField, ShowsTheLargestValueWhereParticlesOverlap)
{
    app::FieldPicture picture{"damage", {}, {}, {}, {}};
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 10; ++j) {
            picture.u.push_back(static_cast<float>(i));
            picture.v.push_back(static_cast<float>(j));
            picture.side.push_back(1);
            picture.value.push_back(0);
        }
    picture.value[105] = 1;
    for (const float value : {0.5f, 0.0f}) { // two more in the same place, given after it
        picture.u.push_back(picture.u[105]);
        picture.v.push_back(picture.v[105]);
        picture.side.push_back(1);
        picture.value.push_back(value);
    }
    const std::string svg = app::svg_field(picture);
    EXPECT_EQ(unbalanced_tag(svg), "");
    EXPECT_PRED2(faults::contains, svg, "<path fill=\"#440154\""); // 0
    EXPECT_PRED2(faults::contains, svg, "<path fill=\"#fde725\""); // 1
    // Column 10, row 10 - 1 - 5 from above, one pixel.
    EXPECT_PRED2(faults::contains, svg, "<path fill=\"#fde725\" d=\"M10 4h1v1h-1z\"/>");
    picture.value[105] = 0;
    EXPECT_EQ(unbalanced_tag(app::svg_field(picture)), ""); // a constant field
    EXPECT_EQ(app::svg_field({"damage", {}, {}, {}, {}}), "");
}
