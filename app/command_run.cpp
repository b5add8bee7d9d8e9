/// `cleave run`: read a case, advance it to its end, write the result directory.
#include "app/bytes_text.h"
#include "app/commands.h"
#include "app/commit.h"
#include "app/compiler_name.h"
#include "app/exit_code.h"
#include "app/forecast.h"
#include "app/hardware_threads.h"
#include "app/log.h"
#include "app/measure_table.h"
#include "app/progress.h"
#include "app/run_files.h"
#include "app/run_options.h"
#include "app/stop_request.h"
#include "app/wall_clock.h"
#include "app/walltime_option.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/grid_file.h"
#include "io/particle_file.h"
#include "io/process_memory.h"
#include "io/vdb_file.h"
#include "io/vtkhdf_series.h"
#include "refine/estimate.h"
#include "solver/lattice.h"
#include "solver/observe.h"
#include "transfer/kernel_level.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <memory>

namespace app
{
namespace
{
struct Run
{
    const solver::Problem& problem;
    solver::Prepared prepared;
    solver::Derived derived;
    solver::State state;
};

/// A run that was killed before its first checkpoint starts again, so that a job script can always say --resume. But
/// not over a finished one, or one of another case.
void require_nothing_to_resume(const RunFiles& files)
{
    const auto record = files.directory / "run.json", resolved = files.directory / "resolved.toml";
    if (!std::filesystem::exists(record)) return;
    if (std::filesystem::exists(resolved)) io::require_same_case(resolved, io::read_file(resolved), files.of_case);
    if (io::read_run_record(record).status == "done")
        throw core::InputError(
            fmt::format("{} holds a finished run without a checkpoint (output.checkpoint.at_end): nothing to "
                        "resume. --force replaces it.",
                        files.directory.string()));
}

/// State and files from the newest checkpoint, or from time 0 if there is none.
void begin(const RunOptions& options, Log& log, Run& run, RunFiles& files)
{
    std::optional<solver::State> stored;
    if (options.resume) {
        stored = io::resume(files.directory / io::checkpoint_files.folder, files.of_case,
                            [&](const std::string& text) { log.line("warning: " + text); });
        if (!stored) {
            require_nothing_to_resume(files);
            log.line("no checkpoint: starts at time 0");
        }
    }
    if (!stored) {
        // The run that --force replaces goes when the new one has begun.
        const bool replaces = options.force && holds_run(files.directory);
        if (!replaces) start_files(files);
        run.state = solver::initialise(run.problem, run.prepared, run.derived);
        if (replaces) start_files(files);
        files.record.particles_start = solver::particles_per_level(run.state);
        open_tables(run.problem, run.state, files);
        write_probes(run.problem, run.prepared, run.derived, run.state, files);
        return;
    }
    const io::RunRecord before = io::read_run_record(files.directory / "run.json");
    files.record.particles_start = before.particles_start;
    files.record.particle_steps = before.particle_steps;
    files.wall_before = before.wall_s;
    files.cpu_before = before.cpu_s;
    continue_files(files);
    run.state = std::move(*stored);
    solver::resume(run.problem, run.prepared, run.state, run.derived);
    open_tables(run.problem, run.state, files);
    for (const io::NumberedFiles& kind : {io::particle_files, io::grid_files})
        io::rewind_series(files.directory / kind.folder / kind.list, run.state.clock.time);
    files.last_vdb = io::last_vdb_frame(files.directory / io::vdb_files.folder, run.state.clock.step);
    for (Schedule* schedule :
         {&files.history_due, &files.probes_due, &files.particles_due, &files.grid_due, &files.vdb_due})
        schedule->skip_to(run.state.clock, run.state.largest_opening);
    log.line(fmt::format("resumed at step {}, t = {:.6g} ms", run.state.clock.step, run.state.clock.time));
}

enum class Ending
{
    done,
    stopped,
};

Ending loop(const RunOptions& options, Log& log, Run& run, RunFiles& files, std::chrono::steady_clock::time_point start)
{
    Progress progress(run.problem.end, log);
    const auto newest = [&] { return run.state.history.empty() ? solver::HistoryLine{} : run.state.history.back(); };
    const Real every_wall = run.problem.output.checkpoint_every_wall;
    while (solver::finished(run.problem, run.state) == solver::Finish::no) {
        solver::advance(run.problem, run.prepared, run.state, run.derived);
        const std::uint64_t updates = solver::updates_per_step(run.problem, run.state);
        files.record.particle_steps += updates;
        write_due(run.problem, run.prepared, run.derived, run.state, files);
        progress.after_step(run.state.clock, newest(), updates);
        const double wall = seconds_since(start);
        if (stop_requested() || (options.walltime && wall > *options.walltime)) {
            write_checkpoint(run.problem, run.state, wall, files);
            return Ending::stopped;
        }
        if (wall - files.last_checkpoint > every_wall) write_checkpoint(run.problem, run.state, wall, files);
    }
    // Before the last line of the history, which ends a mean that a run to a later end would go on with.
    if (run.problem.output.checkpoint_at_end) write_checkpoint(run.problem, run.state, seconds_since(start), files);
    return Ending::done;
}

std::string finish_text(solver::Finish finish)
{
    switch (finish) {
    case solver::Finish::time:
        return "end.time reached";
    case solver::Finish::cod:
        return "end.cod reached";
    case solver::Finish::separated:
        return "the specimen has separated";
    case solver::Finish::no:
        break;
    }
    return "stopped on request, with a checkpoint; --resume continues";
}

void warn_of_memory(const solver::Problem& problem, Log& log)
{
    if (!refine::may_exceed(solver::scene_of(problem), 1e6)) return; // 0.4 GB, which every machine has
    const Real needed = memory_of(estimate_particles(problem)), available = static_cast<Real>(io::machine_bytes());
    if (needed > available)
        log.line(fmt::format("warning: the run needs about {} of memory, this machine has {} (cleave check tells more)",
                             bytes_text(needed), bytes_text(available)));
}

int run_case(const RunOptions& options)
{
    io::Case read = io::read_case_with_warnings(options.file, options.overrides);
    if (options.no_frames) read.problem.output.particles = read.problem.output.grid = read.problem.output.vdb = {};
    const auto directory = result_directory(options);
    RunFiles files = open_files(directory, read);
    Log log(directory / "log.txt");
    if (!log.lock())
        throw core::InputError(
            fmt::format("another run is writing to {}: wait for it, or choose another -o", directory.string()));
    for (const std::string& warning : read.warnings) log.line(warning);
    warn_of_memory(read.problem, log);
    const int threads = options.threads > 0 ? options.threads : hardware_threads();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    files.record.threads = threads;
    files.record.commit = commit();
    files.record.compiler = compiler_name();
    files.record.instruction_set = transfer::kernel_level();
    catch_stop_signals();

    const auto start = std::chrono::steady_clock::now();
    Run run{read.problem, solver::prepare(read.problem), solver::Derived{}, solver::State{}};
    try {
        begin(options, log, run, files);
        write_events(run.problem, run.state, files);
        io::return_free_memory();
        log.line(fmt::format("cleave {}: {}\n{} particles, {} thread{}, results in {}", version_text(),
                             read.problem.title, run.state.particles.size(), threads, threads == 1 ? "" : "s",
                             directory.string()));
        write_record(run.problem, run.state, 0, files);
        const Ending ending = loop(options, log, run, files, start);
        if (ending == Ending::done) {
            // Forces are means since the last line: there is none to form if that was this step.
            if (run.state.history.empty() || run.state.history.back().step != run.state.clock.step)
                write_history_line(run.problem, run.prepared, run.derived, run.state, files);
            write_probes(run.problem, run.prepared, run.derived, run.state, files);
            write_last_frames(run.problem, run.state, files);
        }
        files.record.status = ending == Ending::done ? "done" : "stopped";
        files.record.exit_reason = finish_text(solver::finished(run.problem, run.state));
        write_record(run.problem, run.state, seconds_since(start), files);
        log.line(measure_table(files.record, run.problem));
        return ending == Ending::done ? exit_done : exit_stopped;
    } catch (const std::exception& error) {
        log.file_line(error.what());
        record_failure(run.problem, run.state, error.what(), seconds_since(start), files);
        throw;
    }
}
} // namespace

void add_run(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("run", "Run a case");
    const auto options = std::make_shared<RunOptions>();
    command->add_option("CASE", options->file, "case file")->required();
    command->add_option("-o,--output", options->directory, "result directory (default: results/<name of the case>)");
    command->add_option("--threads", options->threads, "threads (default: all)")->check(CLI::Range(1, 1024));
    command->add_option("--set", options->overrides, "key=value, such as grid.cell=0.5; may be repeated")
        ->allow_extra_args(false);
    CLI::Option* resume =
        command->add_flag("--resume", options->resume, "go on from the newest checkpoint in the result directory");
    command->add_flag("--force", options->force, "replace a run that the result directory holds")->excludes(resume);
    command->add_flag("--no-frames", options->no_frames, "write no particle, grid and volume files");
    add_walltime(*command, options->walltime,
                 "stop with a checkpoint and exit code 75 after this time: 90 (s), 3:50:00, 45min");
    command->callback([&chosen, options] { chosen = [options] { return run_case(*options); }; });
}
} // namespace app
