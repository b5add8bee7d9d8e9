#include "app/measure_table.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
io::RunRecord record()
{
    io::RunRecord record;
    record.measures = {{"peak_force_N", 8200.0},  {"c1_force_N", 7500.0},
                       {"c1_mean_N", 7600.0},     {"c1_cod_mm", std::numeric_limits<Real>::quiet_NaN()},
                       {"energy_residual", 1e-4}, {"crack_path", std::string()}};
    return record;
}

bool holds(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(MeasureTable, compares_with_every_reference)
{
    solver::Problem problem;
    problem.ligaments = {{"A", "D", {}}};
    problem.force_upper = "grip";
    problem.references = {{"experiment", {{"peak_force_N", 8000.0}, {"c1_force_N", 8000.0}}, "A-D-C-E"}};
    EXPECT_FALSE(holds(app::measure_table(record(), problem), "c1_mean_N")); // over no opening
    problem.mean_over = 0.2;
    const std::string table = app::measure_table(record(), problem);
    EXPECT_TRUE(holds(table, "c1_mean_N                   7600 N             8000 N (-5 %)")) << table;
    EXPECT_TRUE(holds(table, "8200 N             8000 N (+2 %)")) << table;
    EXPECT_TRUE(holds(table, "c1_cod_mm              not reached")) << table;
    EXPECT_TRUE(holds(table, "none                   A-D-C-E")) << table;
}

TEST(MeasureTable, shows_what_is_small_as_it_is)
{
    io::RunRecord small;
    small.measures = {{"tip_mm", 0.00123}, {"gap_mm", 2.294}, {"far_mm", -0.25},
                      {"none_mm", 0.0},    {"grip_N", 0.5},   {"pull_N", 7786.6}};
    const std::string table = app::measure_table(small, solver::Problem{});
    for (const char* text : {" 0.00123 mm", " 2.29 mm", " -0.25 mm", " 0.00 mm", " 0.5 N", " 7787 N"})
        EXPECT_TRUE(holds(table, text)) << text << " in " << table;
}

TEST(MeasureTable, says_why_there_is_no_share_of_the_work)
{
    io::RunRecord idle;
    idle.measures = {{"energy_residual", std::numeric_limits<Real>::quiet_NaN()}};
    EXPECT_TRUE(holds(app::measure_table(idle, solver::Problem{}), "energy_residual   no external work\n"))
        << app::measure_table(idle, solver::Problem{});
}

TEST(MeasureTable, leaves_out_what_the_case_does_not_ask)
{
    const std::string table = app::measure_table(record(), solver::Problem{});
    EXPECT_TRUE(holds(table, "energy_residual")) << table;
    for (const char* other : {"peak_force_N", "c1_force_N", "c1_cod_mm", "crack_path"})
        EXPECT_FALSE(holds(table, other)) << table;
}
} // namespace
