/// The challenge specimen at preview resolution against finite elements (cases/snl/elastic_plastic.csv): minutes, so
/// slow.
#include "io/history_file.h"
#include "tests/regression/program.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
namespace fs = std::filesystem;

struct Mean
{
    double upper = 0, lower = 0; // N
};

/// Mean forces over one ringing period of the specimen, about 0.1 mm of opening, around `cod`.
Mean mean_force(const std::vector<solver::HistoryLine>& history, double cod)
{
    Mean mean;
    double time = 0;
    for (std::size_t n = 1; n < history.size(); ++n) {
        if (std::abs(history[n].cod - cod) > 0.05) continue;
        const double span =
            history[n].time - history[n - 1].time; // forces are means over the time since the line before
        mean.upper += span * history[n].force_upper;
        mean.lower += span * history[n].force_lower;
        time += span;
    }
    return {mean.upper / time, mean.lower / time};
}

TEST(SlowSnl, ForcesWithoutFractureMatchFiniteElements)
{
    const support::Folder directory;
    const test::Outcome outcome =
        test::run({"run", CLEAVE_SOURCE_DIR "/cases/snl/no-fracture.toml", "-o", directory.path().string()});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;

    const auto history = io::read_history(directory / "history.csv");
    struct Row
    {
        double cod, low, high;
    };
    for (const Row& row : {Row{0.5, 5600, 5900}, Row{1.0, 7000, 7400}, Row{1.5, 7400, 7800}, Row{2.0, 7600, 7800}}) {
        const Mean force = mean_force(history, row.cod);
        const double middle = (row.low + row.high) / 2;
        EXPECT_NEAR((force.upper + force.lower) / 2, middle, 0.08 * middle) << "at COD " << row.cod;
        EXPECT_NEAR(force.upper, force.lower, 0.03 * middle) << "at COD " << row.cod;
    }
    const solver::Ledger& energy = history.back().energy;
    EXPECT_LT(std::abs(energy.residual()), 0.01 * energy.external);
    EXPECT_EQ(history.back().separated_particles, 0u);
}
} // namespace
