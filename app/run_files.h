/// The result directory of a run (design: section 1): what is written there and when.
#pragma once

#include "app/run_options.h"
#include "io/case.h"
#include "io/checkpoint.h"
#include "io/history_file.h"
#include "io/line_file.h"
#include "io/run_record.h"
#include "io/vdb_file.h"
#include "solver/state.h"
#include "solver/step.h"

#include <ctime>
#include <filesystem>
#include <memory>

namespace app
{
/// Steps between two looks at the opening for outputs that are due by it.
inline constexpr int opening_interval = 16;

/// Counts multiples of an output interval that have gone by, so that an output is due once for each.
struct Schedule
{
    solver::OutputEvery every;
    std::int64_t by_time = 0; // multiples of every.time behind us
    std::int64_t by_cod = 0;  // multiples of every.cod behind us, at the largest opening so far

    /// Is an output due now? Takes it off the schedule.
    bool due(const solver::Clock& clock, std::optional<Real> cod);
    /// Take everything up to now off the schedule: after a restart.
    void skip_to(const solver::Clock& clock, Real largest_cod);
};

/// Open files and schedules of one run.
struct RunFiles
{
    std::filesystem::path directory;
    io::CheckpointCase of_case;
    io::RunRecord record;
    std::unique_ptr<io::HistoryFile> history;
    std::unique_ptr<io::LineFile> probes; // null: the case measures nothing of its own
    Schedule history_due, probes_due, particles_due, grid_due, vdb_due;
    std::optional<std::size_t> events; // lines in events.csv; empty: not written in this part of the run
    io::VdbFrame last_vdb;
    std::int64_t last_particles = -1, last_grid = -1; // steps of the newest frames
    double last_checkpoint = 0;                       // s, wall time since the start of this part
    bool claimed = false;                             // what run.json says is about this run
    double wall_before = 0, cpu_before = 0;           // s, of the parts before a restart
    std::clock_t cpu_start = std::clock();            // processor time of all threads
};

bool holds_run(const std::filesystem::path& directory);

/// Make the directory a run writes to: `-o`, or results/<case>, or with a number behind it if that is there already, so
/// that runs started at the same time have one each.
/// @error core::InputError if `-o` names a directory that holds a run and neither --resume nor --force is given
std::filesystem::path result_directory(const RunOptions& options);

/// Schedules of a run; nothing is written yet: what the directory holds may be another run, and stay so.
RunFiles open_files(const std::filesystem::path& directory, const io::Case& run_case);

/// From here on the directory is this run's: remove what an earlier one left, write the first run.json ("running") and
/// resolved.toml.
void start_files(RunFiles& files);

/// Open history.csv and probes.csv with the lines that the state holds, if the case measures anything.
void open_tables(const solver::Problem& problem, const solver::State& state, RunFiles& files);

/// The same for a run that goes on from a checkpoint: what was written until then stays.
void continue_files(RunFiles& files);

/// Note in run.json why the run failed, if it is this run's. A full disk does not hide the reason.
void record_failure(const solver::Problem& problem, const solver::State& state, const std::string& reason,
                    double wall_s, RunFiles& files);

/// Values of the measures now, to probes.csv; nothing if this step has them already.
void write_probes(const solver::Problem& problem, const solver::Prepared& prepared, const solver::Derived& derived,
                  solver::State& state, RunFiles& files);
/// Append a history line of the present state; write events.csv anew if it saw something.
void write_history_line(const solver::Problem& problem, const solver::Prepared& prepared,
                        const solver::Derived& derived, solver::State& state, RunFiles& files);

/// Write events.csv if it does not hold the events of the state; cases without ligaments have none.
void write_events(const solver::Problem& problem, const solver::State& state, RunFiles& files);

/// Whatever is due at the present step.
void write_due(const solver::Problem& problem, const solver::Prepared& prepared, const solver::Derived& derived,
               solver::State& state, RunFiles& files);

/// One more frame of everything, at the end.
void write_last_frames(const solver::Problem& problem, solver::State& state, RunFiles& files);

/// Write a checkpoint and bring run.json up to date.
void write_checkpoint(const solver::Problem& problem, solver::State& state, double wall_s, RunFiles& files);

/// Write run.json with what the record holds, times and memory brought up to date.
void write_status(double wall_s, RunFiles& files);

/// Bring run.json up to date.
void write_record(const solver::Problem& problem, const solver::State& state, double wall_s, RunFiles& files);
} // namespace app
