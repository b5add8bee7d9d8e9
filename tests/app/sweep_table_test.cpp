#include "app/sweep_table.h"

#include "core/error.h"

#include <gtest/gtest.h>

namespace
{
std::string complaint(const std::string& target, const solver::Problem& problem)
{
    io::Sweep sweep;
    sweep.file = "sweep.toml";
    sweep.targets = {{target, 1, 1}};
    try {
        app::check_targets(sweep, problem);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}
} // namespace

TEST(SweepTargets, are_what_the_runs_measure)
{
    solver::Problem problem;
    problem.quantities.emplace_back().name = "tip_mm";
    EXPECT_EQ(complaint("peak_force_N", problem), "");
    EXPECT_EQ(complaint("c1_mean_N", problem), "");
    EXPECT_EQ(complaint("tip_mm", problem), "");
    EXPECT_TRUE(complaint("peak_force", problem)
                    .starts_with("sweep.toml: target 'peak_force': the runs have no such measure; did you mean "
                                 "'peak_force_N'?\nmeasures: "))
        << complaint("peak_force", problem);
}
