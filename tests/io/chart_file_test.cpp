#include "io/chart_file.h"

#include "core/error.h"
#include "io/csv.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace
{
TEST(Csv, quotes_what_needs_it_and_reads_it_back)
{
    const std::vector<std::string> cells{"plain", "a,b", "say \"so\"", "two\nlines", ""};
    EXPECT_EQ(io::csv_line(cells), "plain,\"a,b\",\"say \"\"so\"\"\",\"two\nlines\",");
    const auto read = io::csv_cells(io::csv_line(cells) + "\n" + io::csv_line({"x"}) + "\n");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0], cells);
    EXPECT_EQ(read[1], std::vector<std::string>{"x"});
}

TEST(ChartFile, rows_come_back)
{
    io::ChartRow row;
    row.scene = "bar";
    row.setting = "flip, h/2";
    row.status = "done";
    row.error = 0.0123;
    row.cpu_s = 1.5;
    row.front = 1;
    row.overrides = "load.a.velocity=[0, \"free\", 1]";
    const support::Folder folder;
    io::write_chart(folder / "chart.csv", {row, {}});
    const std::vector<io::ChartRow> read = io::read_chart(folder / "chart.csv");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].setting, row.setting);
    EXPECT_EQ(read[0].overrides, row.overrides);
    EXPECT_EQ(read[0].error, row.error);
    EXPECT_EQ(read[0].front, 1);
    EXPECT_TRUE(std::isnan(read[0].levels));
    EXPECT_TRUE(std::isnan(read[1].error));
}

TEST(ChartFile, other_tables_are_refused)
{
    const support::Folder folder;
    const std::filesystem::path file = folder / "chart.csv";
    std::ofstream(file) << "a,b\n1,2\n";
    EXPECT_THROW((void)io::read_chart(file), core::FileError);
    io::write_chart(file, {{}});
    std::ofstream(file, std::ios::app) << "short,line\n";
    EXPECT_THROW((void)io::read_chart(file), core::FileError);
}
} // namespace
