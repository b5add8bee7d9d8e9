/// `cleave chart` and `cleave sweep` as a user calls them, on a bar that takes milliseconds.
#include "io/chart_file.h"
#include "io/job_record.h"
#include "io/run_record.h"
#include "tests/regression/program.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace fs = std::filesystem;

namespace
{
constexpr const char* bar = R"(units = "mm-g-ms"
[grid]
cell = 1
[material.steel]
density = 7.81e-3
youngs_modulus = 195e3
poisson_ratio = 0.3
[[body]]
material = "steel"
shape = { box = { lower = [0, 0, 0], upper = [2, 10, 2] } }
[[symmetry]]
axis = "y"
[load.top]
region = { box = { lower = [-inf, 9, -inf], upper = [inf, inf, inf] } }
velocity = 1
axis = "y"
ramp = { time = 0.01 }
[forces]
upper = "top"
[gauge.cod]
upper = [1, 9, 1]
lower = [1, 1, 1]
[end]
time = 0.02
[output]
particles = { every_time = 0.01 }
[[reference]]
name = "made up"
peak_force_N = 1000
)";

constexpr const char* suite = R"(
[[axis]]
name = "scheme"
[[axis.setting]]
label = "nodal"
set = ["numerics.transfer=nodal"]
[[axis.setting]]
label = "flip"
set = ["numerics.transfer=flip"]
[[axis]]
name = "formulation"
[[axis.setting]]
label = "updated"
set = ["numerics.formulation=updated"]
[[axis]]
name = "cells"
resolution = true
[[axis.setting]]
label = "h"
[[axis.setting]]
label = "h/2"
set = ["grid.cell=0.5"]
[[axis]]
name = "too much"
resolution = true
[[axis.setting]]
label = "h/10"
set = ["grid.cell=0.1"]
[[scene]]
name = "pulled bar"
case = "bar.toml"
measure = "measures.peak_force_N"
reference = 1000
limit = "1 s"
stable = { measure = "measures.energy_residual", below = 0.5 }
products = [["scheme", "cells"], ["formulation", "scheme"], ["too much"]]
)";

constexpr const char* sweep = R"(case = "bar.toml"
reference = "made up"
[[vary]]
key = "material.steel.youngs_modulus"
values = ["100 GPa", 300e3, -1]
)";

class Study : public testing::Test
{
protected:
    Study()
    {
        write("bar.toml", bar);
        write("suite.toml", suite);
        write("sweep.toml", sweep);
    }

    void write(const std::string& name, const std::string& text) const { std::ofstream(at(name)) << text; }
    std::string at(const std::string& name) const { return (directory_ / name).string(); }
    std::vector<io::ChartRow> rows() const { return io::read_chart(directory_ / "out/chart.csv"); }
    std::vector<std::string> chart() const { return {"chart", at("suite.toml"), "-o", at("out"), "--jobs", "2"}; }

    support::Folder directory_;
};

const io::ChartRow* find(const std::vector<io::ChartRow>& rows, const std::string& setting)
{
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.setting == setting; });
    return found == rows.end() ? nullptr : &*found;
}

TEST_F(Study, chart_records_what_works_what_fails_and_what_does_not_apply)
{
    const test::Outcome first = test::run(chart());
    ASSERT_EQ(first.exit_code, 0) << first.output;
    const std::vector<io::ChartRow> table = rows();
    // "nodal, h" is the default and "updated, flip" differs from nothing else: 4 + 2 + 1 combinations.
    EXPECT_EQ(table.size(), 7U);
    ASSERT_TRUE(find(table, "default"));
    EXPECT_EQ(find(table, "default")->role, "default");
    EXPECT_EQ(find(table, "default")->status, "done");
    EXPECT_EQ(find(table, "nodal, h"), nullptr);
    EXPECT_EQ(find(table, "nodal, h/2")->role, "scheme");
    EXPECT_EQ(find(table, "nodal, h/2")->scheme, "default");
    EXPECT_EQ(find(table, "flip, h")->role, "");
    EXPECT_GT(find(table, "flip, h")->particle_steps, 0);
    EXPECT_GT(find(table, "flip, h")->cpu_s, 0);
    EXPECT_EQ(find(table, "updated, nodal")->status, "not applicable");
    EXPECT_NE(find(table, "updated, nodal")->reason.find("nodal"), std::string::npos);
    EXPECT_EQ(find(table, "updated, flip")->formulation, "updated");
    EXPECT_EQ(find(table, "h/10")->status, "over limit");
    EXPECT_GT(find(table, "h/10")->cpu_s, 0.3); // of the second its limit gives it, less beside other work
    EXPECT_GE(std::count_if(table.begin(), table.end(), [](const auto& row) { return row.front == 1; }), 1);
    EXPECT_TRUE(fs::exists(directory_ / "out/chart.html"));
    EXPECT_FALSE(fs::exists(directory_ / "out/runs/pulled-bar/flip-h/particles"));

    // Again: nothing is run, not even what failed; one that is missing is.
    const std::string before = test::contents(directory_ / "out/chart.csv");
    EXPECT_EQ(test::run(chart()).output.find("[1/"), std::string::npos);
    EXPECT_EQ(test::contents(directory_ / "out/chart.csv"), before);
    fs::remove_all(directory_ / "out/runs/pulled-bar/flip-h");
    EXPECT_NE(test::run(chart()).output.find("[1/1]"), std::string::npos);
    // Another case: what was measured does not count any more.
    std::string changed = bar;
    changed.replace(changed.find("195e3"), 5, "190e3");
    write("bar.toml", changed);
    EXPECT_NE(test::run(chart()).output.find("[1/6]"), std::string::npos);
}

TEST_F(Study, a_stopped_chart_goes_on)
{
    std::string slow = bar;
    slow.replace(slow.find("cell = 1"), 8, "cell = 0.2");
    write("bar.toml", slow);
    std::string patient = suite;
    patient.replace(patient.find("1 s"), 3, "60 s");
    patient.replace(patient.find(", [\"too much\"]"), 14, "");
    write("suite.toml", patient);
    const fs::path log = directory_ / "log";
    const pid_t process = test::start(chart(), log);
    for (int i = 0; i < 1000 && test::contents(log).find("[1/") == std::string::npos; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(process, SIGTERM);
    const test::Outcome stopped = test::wait_for(process, log);
    ASSERT_EQ(stopped.exit_code, 75) << stopped.output;
    const std::vector<io::ChartRow> part = rows();
    EXPECT_GE(std::count_if(part.begin(), part.end(), [](const auto& row) { return row.status == "pending"; }), 1);
    const test::Outcome rest = test::run(chart());
    ASSERT_EQ(rest.exit_code, 0) << rest.output;
    EXPECT_EQ(rest.output.find("[1/5]"), std::string::npos) << rest.output; // what was done is not repeated
    const test::Outcome summary = test::run({"chart", "--summary", "--from", at("out")});
    EXPECT_EQ(summary.exit_code, 0);
    EXPECT_NE(summary.output.find("its order"), std::string::npos) << summary.output;
    EXPECT_NE(rest.output.find(summary.output), std::string::npos) << rest.output << summary.output;
    const std::vector<io::ChartRow> table = rows();
    EXPECT_EQ(std::count_if(table.begin(), table.end(), [](const auto& row) { return row.status == "done"; }), 5);
}

TEST_F(Study, chart_complains_about_what_it_cannot_do)
{
    write("suite.toml", std::string(suite) + "limitt = 3\n");
    test::Outcome outcome = test::run(chart());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("did you mean 'limit'?"), std::string::npos) << outcome.output;
    std::string wrong = suite;
    wrong.replace(wrong.find("peak_force_N"), 12, "peak_farce_N");
    write("suite.toml", wrong);
    outcome = test::run(chart());
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("did you mean 'measures.peak_force_N'?"), std::string::npos) << outcome.output;
    EXPECT_EQ(test::run({"chart", "--advise", at("bar.toml")}).exit_code, 2); // no --error
    outcome = test::run({"chart", "--advise", at("bar.toml"), "--error", "2"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("did you mean 2%?"), std::string::npos) << outcome.output;
    outcome = test::run({"chart", "--advise", at("bar.toml"), "--error", "2%", "--without", "c1-wave"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("no scene 'c1-wave'; did you mean 'c1-waves'?"), std::string::npos) << outcome.output;
    EXPECT_EQ(test::run({"chart", "--summary", "--advise", at("bar.toml")}).exit_code, 2);
    EXPECT_EQ(test::run({"chart", at("suite.toml"), "--scene", "pulled bor", "-o", at("out")}).exit_code, 2);
}

TEST_F(Study, sweep_tells_the_nearest_run_first)
{
    const std::vector<std::string> words{"sweep", at("sweep.toml"), "-o", at("out")};
    const test::Outcome outcome = test::run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("youngs_modulus=-1: not applicable"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("is out of range"), std::string::npos);
    const std::string table = test::contents(directory_ / "out/sweep.csv");
    EXPECT_EQ(table.rfind("run,status,distance,wall_s,peak_force_N,", 0), 0U) << table;
    // Distances: |F / 1000 - 1|, smaller first.
    const std::size_t soft = table.find("\nyoungs_modulus=100 GPa,done,"),
                      stiff = table.find("\nyoungs_modulus=300000,done,");
    ASSERT_NE(soft, std::string::npos) << table;
    ASSERT_NE(stiff, std::string::npos) << table;
    const auto number = [&](std::size_t at_line) {
        return std::strtod(table.c_str() + table.find("done,", at_line) + 5, nullptr);
    };
    EXPECT_EQ(soft < stiff, number(soft) < number(stiff)) << table;
    EXPECT_EQ(test::run(words).output.find("[1/"), std::string::npos);
}

// It may have been refused because another run was in its directory at that time.
TEST_F(Study, a_run_that_was_refused_is_run_again)
{
    const std::vector<std::string> words{"sweep", at("sweep.toml"), "-o", at("out")};
    ASSERT_EQ(test::run(words).exit_code, 0);
    const fs::path directory = directory_ / "out/runs/youngs_modulus=300000";
    io::JobRecord job = *io::read_job_record(directory / "job.json");
    job.exit_code = 2;
    io::write_job_record(directory / "job.json", job);
    io::RunRecord record = io::read_run_record(directory / "run.json");
    record.status = "running"; // the other was killed
    io::write_run_record(directory / "run.json", record);
    const test::Outcome again = test::run(words);
    EXPECT_NE(again.output.find("[1/1] youngs_modulus=300000"), std::string::npos) << again.output;
    EXPECT_EQ(io::read_job_record(directory / "job.json")->exit_code, 0) << again.output;
    EXPECT_EQ(test::run(words).output.find("[1/"), std::string::npos);
}

TEST_F(Study, slurm_array_runs_and_its_runs_count_as_done)
{
    const test::Outcome outcome = test::run({"sweep", at("sweep.toml"), "-o", at("out"), "--slurm", at("array.sh")});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_NE(test::contents(at("array.sh")).find("#SBATCH --array=0-1\n"), std::string::npos);
    EXPECT_EQ(std::system(("SLURM_ARRAY_TASK_ID=1 sh " + at("array.sh") + " > " + at("log") + " 2>&1").c_str()), 0)
        << test::contents(at("log"));
    const test::Outcome rest = test::run({"sweep", at("sweep.toml"), "-o", at("out")});
    EXPECT_NE(rest.output.find("[1/1] youngs_modulus=100 GPa"), std::string::npos) << rest.output;
}
} // namespace
