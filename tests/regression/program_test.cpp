#include "io/run_record.h"
#include "tests/regression/program.h"
#include "tests/support/folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

namespace fs = std::filesystem;

namespace test
{
pid_t start(const std::vector<std::string>& arguments, const fs::path& output)
{
    std::vector<std::string> words{CLEAVE_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t process = fork();
    if (process != 0) return process;
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
}

Outcome wait_for(pid_t process, const fs::path& output)
{
    int status = 0;
    waitpid(process, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), contents(output)};
}

Outcome run(const std::vector<std::string>& arguments)
{
    const support::Folder folder;
    const fs::path output = folder / "output";
    return wait_for(start(arguments, output), output);
}

std::string contents(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::vector<std::string> files_below(const fs::path& directory)
{
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(directory))
        if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), directory).string());
    std::sort(files.begin(), files.end());
    return files;
}
} // namespace test

namespace
{
const std::string source = CLEAVE_SOURCE_DIR;

/// The challenge preview, so coarse and short that it takes seconds.
std::vector<std::string> tiny_preview(const fs::path& directory, const std::vector<std::string>& more = {})
{
    std::vector<std::string> words{"run",   source + "/cases/snl/preview.toml",
                                   "-o",    directory.string(),
                                   "--set", "grid.cell=1.0",
                                   "--set", "end.time=\"0.015 ms\"",
                                   "--set", "output.particles.every_time=\"0.005 ms\"",
                                   "--set", "output.grid.every_time=\"0.005 ms\"",
                                   "--set", "output.vdb.every_time=\"0.005 ms\""};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

class Program : public testing::Test
{
protected:
    fs::path below(const std::string& name) const { return directory_ / name; }

private:
    support::Folder directory_;
};

bool has_checkpoint(const fs::path& directory)
{
    const std::vector<std::string> files = test::files_below(directory);
    return std::any_of(files.begin(), files.end(), [](const std::string& f) {
        return f.rfind("checkpoint/", 0) == 0 && fs::path(f).extension() == ".h5";
    });
}

/// What a run has left, by relative path; its log goes on whatever happens.
std::map<std::string, std::string> results_in(const fs::path& directory)
{
    std::map<std::string, std::string> results;
    for (const std::string& file : test::files_below(directory))
        if (file != "log.txt") results[file] = test::contents(directory / file);
    return results;
}

/// @param series  the lists of frames, too
void expect_same_results(const fs::path& one, const fs::path& other, bool series)
{
    EXPECT_EQ(test::contents(one / "history.csv"), test::contents(other / "history.csv"));
    EXPECT_EQ(test::contents(one / "events.csv"), test::contents(other / "events.csv"));
    int compared = 0;
    for (const std::string& file : test::files_below(one)) {
        if (file.rfind("particles/", 0) != 0 && file.rfind("grid/", 0) != 0) continue;
        if (!series && fs::path(file).extension() == ".series") continue;
        EXPECT_TRUE(test::contents(one / file) == test::contents(other / file)) << file;
        ++compared;
    }
    EXPECT_GE(compared, 6 + 2 * series);
}
} // namespace

TEST_F(Program, a_preview_run_writes_every_file)
{
    const test::Outcome outcome = test::run(tiny_preview(below("out")));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const char* file : {"history.csv", "events.csv", "log.txt", "resolved.toml", "run.json"})
        EXPECT_GT(test::contents(below("out") / file).size(), 50U) << file;
    int particles = 0, grids = 0, volumes = 0, series = 0;
    for (const std::string& file : test::files_below(below("out"))) {
        particles += file.rfind("particles/", 0) == 0 && fs::path(file).extension() == ".hdf" ? 1 : 0;
        grids += file.rfind("grid/", 0) == 0 && fs::path(file).extension() == ".hdf" ? 1 : 0;
        series += fs::path(file).extension() == ".series" ? 1 : 0;
        volumes += fs::path(file).extension() == ".vdb" ? 1 : 0;
    }
    EXPECT_GE(particles, 3);
    EXPECT_GE(grids, 3);
    EXPECT_GE(volumes, 3);
    EXPECT_EQ(series, 2);
    EXPECT_NE(test::contents(below("out") / "run.json").find("peak_force_N"), std::string::npos);

    EXPECT_EQ(test::run({"metric", below("out").string()}).exit_code, 0);
    EXPECT_EQ(test::run({"report", below("out").string()}).exit_code, 0);
    EXPECT_GT(test::contents(below("out") / "report.html").size(), 1000U);
}

TEST_F(Program, a_wall_time_that_is_none_is_bad_input)
{
    for (const char* text : {"abc", "-5", "3 days", "", "1h 30min", "90 s x", "1:30 h"}) {
        const test::Outcome outcome = test::run(tiny_preview(below("none"), {"--walltime", text}));
        EXPECT_EQ(outcome.exit_code, 2) << text;
        EXPECT_NE(outcome.output.find("--walltime: '" + std::string(text) + "': expected seconds (90)"),
                  std::string::npos)
            << outcome.output;
        EXPECT_FALSE(fs::exists(below("none")));
    }
}

// Stopped after the first step, again in the middle, resumed on another number of threads: the same bits.
TEST_F(Program, a_run_in_three_parts_leaves_the_files_of_one)
{
    const std::vector<std::string> wide{"--set", "output.particles.precision=\"f64\""};
    auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), wide.begin(), wide.end());
        return more;
    };
    ASSERT_EQ(test::run(tiny_preview(below("one"), with({"--threads", "2"}))).exit_code, 0);
    ASSERT_EQ(test::run(tiny_preview(below("parts"), with({"--threads", "1", "--walltime", "0"}))).exit_code, 75);
    EXPECT_TRUE(has_checkpoint(below("parts")));
    const test::Outcome second =
        test::run(tiny_preview(below("parts"), with({"--threads", "2", "--walltime", "0.4", "--resume"})));
    EXPECT_TRUE(second.exit_code == 75 || second.exit_code == 0) << second.output;
    const test::Outcome third = test::run(tiny_preview(below("parts"), with({"--threads", "1", "--resume"})));
    ASSERT_EQ(third.exit_code, 0) << third.output;
    expect_same_results(below("one"), below("parts"), true);
}

// Ended between two frames, gone on to the end of the other run: the same bits, and the frame of the first end stays.
// The opening passes the first 0.3 um between the last line of the history and that end: what is due by it is not due
// again. Tables are those of the checkpoint, whatever has become of their files.
TEST_F(Program, an_ended_run_goes_on_to_a_later_end)
{
    const std::string force = "measure=[{name=\"pin_N\",load={name=\"upper_pin\",what=\"force\",component=\"y\"}}]";
    const auto keeping_its_end = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.end(), {"--set", force, "--set", "output.checkpoint.at_end=true", "--set",
                                 "output.particles.every_cod=3e-4", "--set", "output.probes.every_cod=3e-4"});
        return test::run(tiny_preview(below(name), more));
    };
    ASSERT_EQ(keeping_its_end("one", {}).exit_code, 0);
    ASSERT_EQ(keeping_its_end("parts", {"--set", "end.time=\"0.0083 ms\""}).exit_code, 0);
    const std::int64_t first_end = io::read_run_record(below("parts") / "run.json").steps;
    fs::remove(below("parts") / "history.csv");
    const test::Outcome longer = keeping_its_end("parts", {"--resume"});
    ASSERT_EQ(longer.exit_code, 0) << longer.output;
    expect_same_results(below("one"), below("parts"), false);
    EXPECT_EQ(test::contents(below("one") / "probes.csv"), test::contents(below("parts") / "probes.csv"));
    std::vector<std::string> frames = test::files_below(below("parts") / "particles");
    EXPECT_EQ(std::erase(frames, fmt::format("p_{:06}.hdf", first_end)), 1U);
    EXPECT_EQ(frames, test::files_below(below("one") / "particles"));
}

// Five parts of one step, then the rest; the first frames are due in the third step, and not again in the fourth.
TEST_F(Program, a_resumed_run_writes_no_frame_twice)
{
    const std::vector<std::string> brief{"--set", "end.time=\"0.001 ms\"",
                                         "--set", "output.particles.every_time=\"1e-4 ms\"",
                                         "--set", "output.grid.every_time=\"1e-4 ms\"",
                                         "--set", "output.vdb.every_time=\"1e-4 ms\""};
    ASSERT_EQ(test::run(tiny_preview(below("one"), brief)).exit_code, 0);
    std::vector<std::string> resumed = brief;
    resumed.insert(resumed.end(), {"--resume"});
    std::vector<std::string> one_step = resumed;
    one_step.insert(one_step.end(), {"--walltime", "0"});
    for (int part = 0; part < 5; ++part) ASSERT_EQ(test::run(tiny_preview(below("parts"), one_step)).exit_code, 75);
    io::RunRecord record = io::read_run_record(below("parts") / "run.json");
    EXPECT_GT(record.cpu_s, 0);
    record.wall_s = record.cpu_s = 1000; // what earlier parts took is not lost
    io::write_run_record(below("parts") / "run.json", record);
    ASSERT_EQ(test::run(tiny_preview(below("parts"), resumed)).exit_code, 0);
    record = io::read_run_record(below("parts") / "run.json");
    EXPECT_GT(record.wall_s, 1000);
    EXPECT_GT(record.cpu_s, 1000);
    const auto frames = [&](const std::string& run) {
        std::vector<std::string> files = test::files_below(below(run));
        std::erase_if(files, [](const std::string& f) { return f.find('/') == f.npos || f.rfind("check", 0) == 0; });
        return files;
    };
    EXPECT_GE(frames("one").size(), 3U * 8);
    EXPECT_EQ(frames("one"), frames("parts"));
    for (const char* series : {"particles/particles.hdf.series", "grid/grid.hdf.series"})
        EXPECT_EQ(test::contents(below("one") / series), test::contents(below("parts") / series));
}

TEST_F(Program, a_termination_signal_or_a_closed_terminal_stops_it_with_a_checkpoint)
{
    const auto before = std::signal(SIGHUP, SIG_DFL); // runs inherit that it is ignored, as below nohup
    for (const auto& [signal, name] : {std::pair(SIGTERM, "term"), std::pair(SIGHUP, "hup")}) {
        const fs::path output = below("out.txt"), directory = below(name);
        const pid_t process = test::start(tiny_preview(directory, {"--set", "end.time=\"1.5 ms\""}), output);
        for (int n = 0; n < 200 && !fs::exists(directory / "history.csv"); ++n) usleep(50000);
        kill(process, signal);
        const test::Outcome outcome = test::wait_for(process, output);
        EXPECT_EQ(outcome.exit_code, 75) << name << outcome.output;
        EXPECT_TRUE(has_checkpoint(directory)) << name;
    }
    std::signal(SIGHUP, before);
}

TEST_F(Program, bad_input_has_exit_code_2)
{
    std::ofstream(below("bad.toml")) << "units = \"mm-g-ms\"\n[grid]\ncel = 1\n";
    const test::Outcome typo = test::run({"run", below("bad.toml").string(), "-o", below("out").string()});
    EXPECT_EQ(typo.exit_code, 2);
    EXPECT_NE(typo.output.find("cel"), std::string::npos) << typo.output;
    EXPECT_EQ(test::run(tiny_preview(below("out"), {"--set", "grid.cell=-1"})).exit_code, 2);
    EXPECT_EQ(test::run({"run", "--no-such-option"}).exit_code, 2);
    EXPECT_EQ(test::run({"new", ""}).exit_code, 2);
    const test::Outcome bench = test::run({"bench", "--transfer", "nodal", "--formulation", "updated"});
    EXPECT_EQ(bench.exit_code, 2);
    EXPECT_NE(bench.output.find("there is no scheme with all of these"), std::string::npos) << bench.output;
    const test::Outcome command = test::run({"chek"});
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_NE(command.output.find("there is no command 'chek'; did you mean 'check'?"), std::string::npos)
        << command.output;
}

TEST_F(Program, numerical_failure_has_exit_code_3)
{
    const test::Outcome outcome =
        test::run(tiny_preview(below("out"), {"--set", "load.upper_pin.velocity=[0, 1e9, 0]"}));
    EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
    EXPECT_NE(outcome.output.find("particle"), std::string::npos) << outcome.output;
    EXPECT_NE(test::contents(below("out") / "run.json").find("failed"), std::string::npos);
}

TEST_F(Program, numerical_failure_before_the_first_step_has_exit_code_3)
{
    const std::string bar = std::string(CLEAVE_SOURCE_DIR) + "/cases/verification/c5-bar/case.toml";
    const test::Outcome outcome = test::run({"run", bar, "--set", "numerics.formulation=updated", "--set",
                                             "motion.mode.standing_wave.speed=1e9", "-o", below("out").string()});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
    EXPECT_NE(test::contents(below("out") / "run.json").find("the stable time step has fallen"), std::string::npos);
}

TEST_F(Program, file_errors_have_exit_code_4)
{
    std::ofstream(below("file")) << "not a directory";
    const test::Outcome outcome = test::run(tiny_preview(below("file") / "out"));
    EXPECT_EQ(outcome.exit_code, 4) << outcome.output;
}

TEST_F(Program, a_directory_that_holds_a_run_is_not_overwritten)
{
    const std::vector<std::string> brief{"--walltime", "0"};
    ASSERT_EQ(test::run(tiny_preview(below("out"), brief)).exit_code, 75);
    EXPECT_EQ(test::run(tiny_preview(below("out"), brief)).exit_code, 2);
    EXPECT_EQ(test::run(tiny_preview(below("out"), {"--walltime", "0", "--force"})).exit_code, 75);
}

TEST_F(Program, a_refused_resume_leaves_the_run_as_it_was)
{
    ASSERT_EQ(test::run(tiny_preview(below("out"), {"--walltime", "0"})).exit_code, 75);
    for (const bool killed : {false, true}) { // before its first checkpoint
        if (killed) fs::remove_all(below("out") / "checkpoint");
        const auto before = results_in(below("out"));
        const test::Outcome other = test::run(tiny_preview(below("out"), {"--resume", "--set", "numerics.cfl=0.3"}));
        EXPECT_EQ(other.exit_code, 2) << killed;
        EXPECT_NE(other.output.find("it belongs to another case"), std::string::npos) << other.output;
        EXPECT_TRUE(results_in(below("out")) == before) << killed;
    }
    // Its own case starts again.
    EXPECT_EQ(test::run(tiny_preview(below("out"), {"--resume", "--walltime", "0"})).exit_code, 75);
}

TEST_F(Program, force_removes_what_the_run_before_left)
{
    const std::vector<std::string> brief{"--set", "end.time=\"0.004 ms\"", "--set",
                                         "output.vdb.every_time=\"1e-4 ms\""};
    ASSERT_EQ(test::run(tiny_preview(below("out"), brief)).exit_code, 0);
    std::ofstream(below("out") / "note.txt") << "the user's";
    EXPECT_GT(test::files_below(below("out") / "vdb").size(), 20U);
    ASSERT_EQ(test::run(tiny_preview(below("out"), {"--walltime", "0", "--force"})).exit_code, 75);
    EXPECT_FALSE(fs::exists(below("out") / "vdb"));
    EXPECT_FALSE(fs::exists(below("out") / "particles"));
    EXPECT_TRUE(fs::exists(below("out") / "note.txt"));
}

TEST_F(Program, force_keeps_what_the_run_before_left_until_the_new_one_has_begun)
{
    ASSERT_EQ(test::run(tiny_preview(below("out"), {"--walltime", "0"})).exit_code, 75);
    const auto before = results_in(below("out"));
    const std::string faceless =
        "load.push={region={box={lower=[31,-1,-inf],upper=[inf,1,inf]}},pressure=1,facing=[-1,0,0]}";
    const test::Outcome outcome = test::run(tiny_preview(below("out"), {"--force", "--set", faceless}));
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.output.find("load 'push' finds no surface"), std::string::npos) << outcome.output;
    EXPECT_TRUE(results_in(below("out")) == before);
}

TEST_F(Program, a_second_run_in_a_directory_is_refused)
{
    const fs::path output = below("out.txt");
    const pid_t process = test::start(tiny_preview(below("out"), {"--set", "end.time=\"1.5 ms\""}), output);
    for (int n = 0; n < 200 && !fs::exists(below("out") / "history.csv"); ++n) usleep(50000);
    const std::string history = test::contents(below("out") / "history.csv");
    for (const char* way : {"--resume", "--force"}) {
        const test::Outcome second = test::run(tiny_preview(below("out"), {way}));
        EXPECT_EQ(second.exit_code, 2) << way;
        EXPECT_NE(second.output.find("another run is writing"), std::string::npos) << second.output;
    }
    kill(process, SIGTERM);
    EXPECT_EQ(test::wait_for(process, output).exit_code, 75);
    EXPECT_TRUE(test::contents(below("out") / "history.csv").starts_with(history));
}

TEST_F(Program, a_frame_that_cannot_be_written_is_on_record)
{
    fs::create_directories(below("out"));
    std::ofstream(below("out") / "particles") << "in the way";
    EXPECT_EQ(test::run(tiny_preview(below("out"))).exit_code, 4);
    const io::RunRecord record = io::read_run_record(below("out") / "run.json");
    EXPECT_EQ(record.status, "failed");
    EXPECT_NE(record.exit_reason.find("particles"), std::string::npos) << record.exit_reason;
    EXPECT_NE(test::contents(below("out") / "log.txt").find(record.exit_reason), std::string::npos);
}
