#include "io/history_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

TEST(HistoryFile, StartsWithTheColumnsOfTheContract)
{
    EXPECT_EQ(io::history_header(2).rfind("step,time_ms,dt_ms,force_upper_N,force_lower_N,cod_mm,", 0), 0u);
    EXPECT_EQ(io::history_header(2),
              "step,time_ms,dt_ms,force_upper_N,force_lower_N,cod_mm,kinetic_mJ,elastic_mJ,"
              "plastic_mJ,decohesion_mJ,damping_mJ,external_mJ,initial_mJ,residual_mJ,max_damage,"
              "separated_particles,particles_l0,particles_l1");
    const solver::State state = sample::state();
    EXPECT_EQ(io::history_text(state.history[2]),
              "200,0.01666666667,1.25e-05,666.6666667,-660,0.2857142857,0.2,0.2,6,1,0.25,8,0.25,0.6,0.5,2,2048,4098");
}

TEST(HistoryFile, IsOnDiskAfterEveryLineAndReadsBack)
{
    const support::Folder folder;
    const auto path = folder.path() / "history.csv";
    const auto history = sample::state().history;
    io::HistoryFile file(path, 2, {});
    for (std::size_t i = 0; i < history.size(); ++i) {
        file.append(history[i]);
        const auto lines = io::read_history(path); // while the file is open
        ASSERT_EQ(lines.size(), i + 1);
        EXPECT_EQ(lines[i].step, history[i].step);
        EXPECT_NEAR(lines[i].force_upper, history[i].force_upper, 1e-9 * history[i].force_upper);
        EXPECT_NEAR(lines[i].energy.residual(), history[i].energy.residual(), 1e-8);
        EXPECT_EQ(lines[i].max_damage, history[i].max_damage);
        EXPECT_EQ(lines[i].separated_particles, history[i].separated_particles);
        EXPECT_EQ(lines[i].particles, history[i].particles);
    }
}

// Whatever stands in the old file: more than the checkpoint knows, a line cut short by a kill, or another run's.
TEST(HistoryFile, BeginsWithTheHistoryOfTheCheckpoint)
{
    const support::Folder folder;
    const auto path = folder.path() / "history.csv";
    const auto history = sample::state().history;
    {
        io::HistoryFile file(path, 2, {});
        for (const auto& line : history) file.append(line);
    }
    const std::string whole = io::read_file(path);
    for (const std::string& old : {whole + "500,0.1,1e", std::string("a,b\n1,2\n")}) {
        io::write_file(path, old);
        io::HistoryFile resumed(path, 2, {history.begin(), history.begin() + 3});
        EXPECT_EQ(io::read_history(path).size(), 3u);
        resumed.append(history[3]);
        resumed.append(history[4]);
        EXPECT_EQ(io::read_file(path), whole);
    }
}

TEST(LineFile, BeginsWithItsHeaderAndTheLinesThereAre)
{
    const support::Folder folder;
    const auto path = folder.path() / "probes.csv";
    io::LineFile file(path, "step,tip_mm", {"1,0.5", "2,0.75"});
    file.append("3,1");
    EXPECT_EQ(io::read_file(path), "step,tip_mm\n1,0.5\n2,0.75\n3,1\n");
    io::LineFile fresh(path, "step", {});
    EXPECT_EQ(io::read_file(path), "step\n");
}

TEST(HistoryFile, ReportsAFullDiskAndAForeignFile)
{
    const support::Folder folder;
    const auto path = folder.path() / "history.csv";
    io::HistoryFile file(path, 2, {});
    {
        const faults::FileSizeLimit limit(std::filesystem::file_size(path));
        EXPECT_PRED2(faults::contains,
                     faults::message<core::FileError>([&] { file.append(sample::state().history[0]); }),
                     "history.csv': File too large");
    }
    io::write_file(path, "a,b\n1,2\n");
    EXPECT_PRED2(faults::contains, faults::message<core::FileError>([&] { io::read_history(path); }), "line 1");
    io::write_file(path, io::history_header(1) + "\n1,2,3\n");
    EXPECT_PRED2(faults::contains, faults::message<core::FileError>([&] { io::read_history(path); }),
                 "line 2 has not 17 numbers");
}
