#include "app/study.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace
{
constexpr const char* bar = R"(units = "mm-g-ms"
[grid]
cell = 1
[material.steel]
density = 7.81e-3
youngs_modulus = 195e3
poisson_ratio = 0.3
[feature.gap]
centre = [0, 10, 0]
axis = "z"
shape = { box = { lower = [0, 5, 0], upper = [2, 10, inf] } }
[[body]]
material = "steel"
shape = { difference = { from = { box = { lower = [0, 0, 0], upper = [2, 10, 4] } }, holes = [{ feature = "gap" }] } }
[end]
time = 100
[numerics]
transfer = "flip"
)";

/// Expected times of the bar with these overrides, as multiples of that of the first.
std::vector<Real> costs(const std::vector<std::vector<std::string>>& overrides)
{
    const support::Folder folder;
    std::ofstream(folder / "bar.toml") << bar;
    std::vector<app::StudyRun> runs(overrides.size());
    std::vector<app::StudyRun*> all;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        runs[i].file = folder / "bar.toml";
        runs[i].overrides = overrides[i];
        all.push_back(&runs[i]);
    }
    app::prepare_runs(runs);
    for (const app::StudyRun& run : runs) EXPECT_EQ(run.not_applicable, "");
    app::expect_costs(all);
    constexpr Real start = 0.05; // s
    std::vector<Real> multiples;
    for (const app::StudyRun& run : runs)
        multiples.push_back((run.expected_s - start) / (runs.front().expected_s - start));
    return multiples;
}

TEST(StudyCost, what_changes_the_grid_is_counted_anew)
{
    const std::vector<Real> cost =
        costs({{},
               {"end.time=200"},
               {"grid.cell=0.5"},
               {"grid.particles_per_cell=27"},
               {"feature.gap.shape.box.lower=[0, 6, 0]"},
               {"body.0.shape.difference.from.box.upper=[2, 10, 8]"},
               {"grid.levels=2", "refine.zone=[{shape={box={lower=[0, 0, 0], upper=[2, 5, 2]}}, level=1}]"},
               {"grid.levels=2", "refine.zone=[{shape={box={lower=[0, 0, 0], upper=[2, 5, 4]}}, level=1}]"}});
    EXPECT_NEAR(cost[1], 2, 1e-3);
    EXPECT_NEAR(cost[2], 16, 0.05); // eight times the cells, twice the steps
    EXPECT_NEAR(cost[3], 27.0 / 8, 1e-3);
    EXPECT_NEAR(cost[4], 1.2, 1e-3);
    EXPECT_NEAR(cost[5], 2, 1e-3);
    EXPECT_NEAR(cost[6], 2 * (1 + 8) / 2.0, 0.05); // half of it with half the cells
    EXPECT_NEAR(cost[7], 16, 0.05);
}
} // namespace
