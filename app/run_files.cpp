#include "app/run_files.h"

#include "app/modelled.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/event_file.h"
#include "io/grid_file.h"
#include "io/particle_file.h"
#include "io/probe_file.h"
#include "io/process_memory.h"
#include "solver/measures.h"
#include "solver/nodal.h"
#include "solver/observe.h"
#include "solver/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app
{
namespace
{
namespace fs = std::filesystem;

std::int64_t multiples(Real value, Real every)
{
    // The tolerance keeps a clock that sums steps from missing a multiple by its last bit.
    return static_cast<std::int64_t>(std::floor(value / every * (1 + 1e-12)));
}

void write_particles(const solver::Problem& problem, const solver::State& state, RunFiles& files)
{
    files.last_particles = state.clock.step;
    io::ParticleFileOptions options;
    options.fields = problem.output.particle_fields;
    options.precision = problem.output.particle_precision == "f64" ? io::Precision::f64 : io::Precision::f32;
    options.particles_per_cell = problem.grid.particles_per_cell;
    options.version = CLEAVE_VERSION;
    io::write_particle_frame(files.directory / io::particle_files.folder, state.particles, state.levels, state.clock,
                             options);
}

void write_grid(const solver::Problem& problem, const solver::State& state, RunFiles& files)
{
    files.last_grid = state.clock.step;
    const io::GridFileOptions options{problem.output.grid_fields, CLEAVE_VERSION};
    io::write_grid_frame(files.directory / io::grid_files.folder, state.particles, state.levels, state.clock, options);
}

void write_volume(const solver::Problem& problem, const solver::State& state, RunFiles& files)
{
    files.last_vdb = {files.last_vdb.number + 1, state.clock.step};
    io::VdbFileOptions options;
    options.grids = problem.output.vdb_grids;
    options.preset = problem.output.vdb_preset;
    options.scale = problem.output.vdb_scale;
    options.particles_per_cell = problem.grid.particles_per_cell;
    options.version = CLEAVE_VERSION;
    io::write_vdb_frame(files.directory / io::vdb_files.folder, files.last_vdb.number, state.particles, state.levels,
                        state.clock, options);
}

bool wanted(const solver::OutputEvery& every)
{
    return every.time || every.steps || every.cod;
}

/// What an earlier run has written; anything else stays.
void remove_results(const fs::path& directory)
{
    for (const char* name : {"run.json", "history.csv", "events.csv", "probes.csv", "report.html"})
        fs::remove(directory / name);
    for (const io::NumberedFiles& kind : {io::checkpoint_files, io::particle_files, io::grid_files, io::vdb_files})
        io::remove_all(directory, kind);
}

/// Make a directory that is not there yet.
/// @return false if it is
/// @error core::FileError
bool make_new(const fs::path& directory)
{
    std::error_code error;
    if (fs::create_directory(directory, error)) return true;
    if (error) io::throw_file_error("make", directory, error.value());
    return false;
}
} // namespace

bool holds_run(const fs::path& directory)
{
    return fs::exists(directory / "run.json");
}

bool Schedule::due(const solver::Clock& clock, std::optional<Real> cod)
{
    bool now = every.steps && clock.step % *every.steps == 0;
    if (every.time) {
        const std::int64_t count = multiples(clock.time, *every.time);
        now = now || count > by_time;
        by_time = count;
    }
    if (every.cod && cod) {
        const std::int64_t count = multiples(*cod, *every.cod);
        now = now || count > by_cod;
        by_cod = std::max(by_cod, count);
    }
    return now;
}

void Schedule::skip_to(const solver::Clock& clock, Real largest_cod)
{
    if (every.time) by_time = multiples(clock.time, *every.time);
    if (every.cod) by_cod = std::max<std::int64_t>(0, multiples(largest_cod, *every.cod));
}

fs::path result_directory(const RunOptions& options)
{
    const bool named = !options.directory.empty(), again = options.resume || options.force;
    const std::string name = fs::path(options.file).stem().string();
    fs::path directory = named ? fs::path(options.directory) : fs::path("results") / name;
    if (named || again) {
        if (holds_run(directory) && !again)
            throw core::InputError(fmt::format("{} holds a run already. --resume continues it, --force replaces it, or "
                                               "choose another -o.",
                                               options.directory));
        io::make_directory(directory);
        return directory;
    }
    io::make_directory("results");
    for (int n = 2; !make_new(directory); ++n) directory = fs::path("results") / fmt::format("{}-{}", name, n);
    return directory;
}

RunFiles open_files(const fs::path& directory, const io::Case& run_case)
{
    RunFiles files;
    files.directory = directory;
    files.of_case = {run_case.resolved, CLEAVE_VERSION};
    files.record.references = run_case.problem.references;
    files.record.title = run_case.problem.title;
    files.record.version = CLEAVE_VERSION;
    files.history_due.every = run_case.problem.output.history;
    files.probes_due.every = run_case.problem.output.probes;
    files.particles_due.every = run_case.problem.output.particles;
    files.grid_due.every = run_case.problem.output.grid;
    files.vdb_due.every = run_case.problem.output.vdb;
    return files;
}

void start_files(RunFiles& files)
{
    if (holds_run(files.directory)) remove_results(files.directory);
    continue_files(files);
}

void continue_files(RunFiles& files)
{
    files.claimed = true;
    io::write_file(files.directory / "resolved.toml", files.of_case.resolved);
    write_status(0, files);
}

void open_tables(const solver::Problem& problem, const solver::State& state, RunFiles& files)
{
    files.history =
        std::make_unique<io::HistoryFile>(files.directory / "history.csv", problem.grid.levels, state.history);
    if (problem.quantities.empty()) return;
    std::vector<std::string> lines;
    for (const solver::Sample& sample : state.samples) lines.push_back(io::probe_text(problem.quantities, sample));
    files.probes =
        std::make_unique<io::LineFile>(files.directory / "probes.csv", io::probe_header(problem.quantities), lines);
}

void write_probes(const solver::Problem& problem, const solver::Prepared& prepared, const solver::Derived& derived,
                  solver::State& state, RunFiles& files)
{
    if (!files.probes || (!state.samples.empty() && state.samples.back().step == state.clock.step)) return;
    files.probes->append(io::probe_text(problem.quantities, take_sample(problem, prepared, derived, state)));
}

void write_events(const solver::Problem& problem, const solver::State& state, RunFiles& files)
{
    if (problem.ligaments.empty() || files.events == state.events.size()) return;
    io::write_file(files.directory / "events.csv", io::events_text(problem, state));
    files.events = state.events.size();
}

void write_history_line(const solver::Problem& problem, const solver::Prepared& prepared,
                        const solver::Derived& derived, solver::State& state, RunFiles& files)
{
    files.history->append(solver::observe(problem, prepared, derived, state));
    write_events(problem, state, files);
}

void write_due(const solver::Problem& problem, const solver::Prepared& prepared, const solver::Derived& derived,
               solver::State& state, RunFiles& files)
{
    std::optional<Real> cod;
    if (state.clock.step % opening_interval == 0) {
        cod = solver::gauge_opening(problem, state, derived);
        state.largest_opening = std::max(state.largest_opening, *cod);
    }
    const bool history = files.history_due.due(state.clock, cod);
    if (history) write_history_line(problem, prepared, derived, state, files);
    if (wanted(problem.output.probes) ? files.probes_due.due(state.clock, cod) : history)
        write_probes(problem, prepared, derived, state, files);
    const bool particles = files.particles_due.due(state.clock, cod);
    const bool grid = files.grid_due.due(state.clock, cod);
    const bool volume = files.vdb_due.due(state.clock, cod);
    if (!particles && !grid && !volume) return;
    {
        const solver::OutputColumns columns(state);
        if (particles) write_particles(problem, state, files);
        if (grid) write_grid(problem, state, files);
        if (volume) write_volume(problem, state, files);
    }
    io::return_free_memory();
}

void write_last_frames(const solver::Problem& problem, solver::State& state, RunFiles& files)
{
    const solver::OutputColumns columns(state);
    if (wanted(problem.output.particles) && files.last_particles != state.clock.step)
        write_particles(problem, state, files);
    if (wanted(problem.output.grid) && files.last_grid != state.clock.step) write_grid(problem, state, files);
    if (wanted(problem.output.vdb) && files.last_vdb.step != state.clock.step) write_volume(problem, state, files);
}

void write_checkpoint(const solver::Problem& problem, solver::State& state, double wall_s, RunFiles& files)
{
    const solver::OutputColumns columns(state);
    io::write_checkpoint(files.directory / io::checkpoint_files.folder, state, files.of_case,
                         problem.output.checkpoint_keep);
    files.last_checkpoint = wall_s;
    write_record(problem, state, wall_s, files);
}

void write_status(double wall_s, RunFiles& files)
{
    files.record.wall_s = files.wall_before + wall_s;
    files.record.cpu_s = files.cpu_before + static_cast<Real>(std::clock() - files.cpu_start) / CLOCKS_PER_SEC;
    files.record.peak_rss_bytes = io::peak_resident_bytes();
    io::write_run_record(files.directory / "run.json", files.record);
}

void record_failure(const solver::Problem& problem, const solver::State& state, const std::string& reason,
                    double wall_s, RunFiles& files)
{
    if (!files.claimed) return;
    files.record.status = "failed";
    files.record.exit_reason = reason;
    try {
        if (state.particles.size() > 0)
            write_record(problem, state, wall_s, files);
        else
            write_status(wall_s, files); // it failed before there was a state
    } catch (const core::FileError&) {
    }
}

void write_record(const solver::Problem& problem, const solver::State& state, double wall_s, RunFiles& files)
{
    io::RunRecord& record = files.record;
    record.steps = state.clock.step;
    record.particles_end = solver::particles_per_level(state);
    record.modelled = modelled(problem, state);
    const solver::Measures measures = solver::measures(problem, state.history, state.ligaments);
    record.measures.clear();
    for (const solver::Measure& m : measures.numbers)
        record.measures.push_back({m.name, m.value.value_or(std::numeric_limits<Real>::quiet_NaN())});
    record.measures.push_back({"crack_path", measures.crack_path});
    record.targets.clear();
    const std::vector<Real> results = solver::results(problem.quantities, state.samples);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const solver::Quantity& quantity = problem.quantities[i];
        record.measures.push_back({quantity.name, results[i]});
        if (quantity.reference)
            record.targets.push_back({quantity.name, *quantity.reference,
                                      solver::relative_error(results[i], *quantity.reference), quantity.tolerance});
    }
    write_status(wall_s, files);
}
} // namespace app
