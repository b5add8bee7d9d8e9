/// `cleave sweep`: many runs of one case, compared with wanted values.
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/hardware_threads.h"
#include "app/log.h"
#include "app/stop_request.h"
#include "app/sweep_table.h"
#include "app/walltime_option.h"
#include "core/error.h"
#include "io/atomic_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace app
{
namespace
{
namespace fs = std::filesystem;

struct Options
{
    std::string file;
    std::string directory;
    std::string slurm; // script to write instead of running; empty: run
    StudyOptions study;
    int jobs = 0; // 0: as many as the machine's threads allow
};

std::vector<StudyRun> planned_runs(const io::Sweep& sweep, const fs::path& directory)
{
    std::vector<StudyRun> runs;
    std::vector<std::string> directories;
    for (const io::Setting& setting : sweep.runs) {
        StudyRun run;
        run.label = setting.label;
        run.file = sweep.file;
        run.overrides = sweep.set;
        run.overrides.insert(run.overrides.end(), setting.set.begin(), setting.set.end());
        run.limit = sweep.limit.value_or(0);
        run.directory = directory / "runs" / new_directory_name(setting.label, directories);
        runs.push_back(std::move(run));
    }
    prepare_runs(runs);
    return runs;
}

int write_slurm(const Options& options, const io::Sweep& sweep, std::vector<StudyRun> runs)
{
    std::erase_if(runs, [](const StudyRun& run) { return run.resolved.empty(); });
    for (StudyRun& run : runs) {
        run.file = fs::absolute(run.file);
        run.directory = fs::absolute(run.directory);
    }
    io::write_file(options.slurm, slurm_script(sweep, runs, fs::read_symlink("/proc/self/exe").string()));
    fmt::print("{}: an array of {} tasks; adapt its time and partition, then: sbatch {}\n", options.slurm, runs.size(),
               options.slurm);
    return exit_done;
}

int sweep(Options options)
{
    const io::Sweep sweep = io::read_sweep(options.file);
    const fs::path directory =
        options.directory.empty() ? fs::path("results") / fs::path(options.file).stem() : fs::path(options.directory);
    catch_stop_signals();
    std::vector<StudyRun> runs = planned_runs(sweep, directory);
    for (const StudyRun& run : runs)
        if (run.resolved.empty()) say(fmt::format("{}: not applicable\n{}\n", run.label, run.not_applicable));
    if (std::all_of(runs.begin(), runs.end(), [](const StudyRun& run) { return run.resolved.empty(); }))
        throw core::InputError(fmt::format("{}: no run of the sweep is applicable", options.file));
    if (!options.slurm.empty()) return write_slurm(options, sweep, std::move(runs));
    options.study.threads = sweep.threads;
    options.study.jobs = options.jobs > 0 ? options.jobs : std::max(1, hardware_threads() / sweep.threads);
    say(fmt::format("{}: {} runs, {} at a time on {} thread{} each, results in {}\n",
                    sweep.title.empty() ? options.file : sweep.title, runs.size(), options.study.jobs, sweep.threads,
                    sweep.threads == 1 ? "" : "s", directory.string()));
    io::make_directory(directory);
    const PoolEnd end = run_study(options.study, runs);
    const std::vector<SweepRow> rows = sweep_rows(sweep, runs);
    io::write_file(directory / "sweep.csv", sweep_csv(rows));
    say(fmt::format("\n{}\n{}\n", sweep_text(sweep, rows), (directory / "sweep.csv").string()));
    if (end == PoolEnd::all_done) return exit_done;
    say("stopped; the same command goes on\n");
    return exit_stopped;
}
} // namespace

void add_sweep(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("sweep", "Many runs of one case, compared with wanted values");
    const auto options = std::make_shared<Options>();
    command->add_option("SWEEP", options->file, "sweep file (cleave keys sweep)")->required();
    command->add_option("-o,--output", options->directory, "directory (default: results/<name of the sweep>)");
    command->add_option("--jobs", options->jobs, "runs at a time (default: all threads over the threads of a run)")
        ->check(CLI::Range(1, 1024));
    add_walltime(*command, options->study.walltime,
                 "stop with checkpoints and exit code 75 after this time; the same command goes on");
    command->add_flag("--again", options->study.again, "repeat finished runs, too");
    command->add_option("--slurm", options->slurm, "run nothing: write a job array script for Slurm to this file");
    command->callback([&chosen, options] { chosen = [options] { return sweep(*options); }; });
}
} // namespace app
