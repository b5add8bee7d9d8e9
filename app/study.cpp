#include "app/study.h"

#include "app/exit_code.h"
#include "app/forecast.h"
#include "app/log.h"
#include "app/wall_clock.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/case.h"
#include "io/run_record.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>

namespace app
{
namespace
{
namespace fs = std::filesystem;

fs::path record_path(const StudyRun& run)
{
    return run.directory / "job.json";
}

/// Did the run end for a reason that lies in itself, so that repeating it would give the same? Not so one that was
/// refused: the directory may have been another's at that time, or the memory.
bool settled(const io::JobRecord& record, Real limit)
{
    if (record.over_limit) return limit > 0 && record.limit_s >= limit;
    return record.exit_code == exit_done || record.exit_code == exit_numerical;
}

bool same_case(const StudyRun& run)
{
    const fs::path resolved = run.directory / "resolved.toml";
    return fs::exists(resolved) && io::read_file(resolved) == run.resolved;
}

std::string outcome(const io::JobRecord& record)
{
    if (record.over_limit) return fmt::format("over the limit of {:.0f} s", record.limit_s);
    switch (record.exit_code) {
    case exit_done:
        return "done";
    case exit_numerical:
        return "numerical failure";
    case exit_stopped:
        return "stopped";
    default:
        return record.exit_code < 0 ? fmt::format("ended by signal {}", -record.exit_code)
                                    : fmt::format("ended with code {}", record.exit_code);
    }
}

/// A run that the pool did not start, but which is done.
std::optional<io::JobRecord> record_of_other(const StudyRun& run)
{
    if (!fs::exists(run.directory / "run.json")) return {};
    const io::RunRecord other = io::read_run_record(run.directory / "run.json");
    if (other.status != "done") return {};
    return io::JobRecord{other.version, exit_done, false, 0, other.cpu_s, other.wall_s, other.peak_rss_bytes};
}

/// Lines about runs that end, and how long the rest will take: the expected cost of each run, corrected by how wrong
/// that was for those that ended.
class Progress
{
public:
    Progress(std::vector<const StudyRun*> runs, int slots)
        : runs_(std::move(runs)), slots_(slots), terminal_(::isatty(STDOUT_FILENO) == 1)
    {
        for (const StudyRun* run : runs_) expected_left_ += run->expected_s;
    }

    void started(std::size_t job)
    {
        under_way_.push_back(job);
        show();
    }

    void ended(std::size_t job)
    {
        const StudyRun& run = *runs_[job];
        std::erase(under_way_, job);
        ++done_;
        expected_left_ -= run.expected_s;
        expected_done_ += run.expected_s;
        spent_ += run.record->cpu_s;
        const std::size_t width = std::to_string(runs_.size()).size();
        say(fmt::format("{}[{:>{}}/{}] {:<50} {:<18} {:8.2f} s{}\n", terminal_ ? "\r\033[K" : "", done_, width,
                        runs_.size(), run.label, outcome(*run.record), run.record->cpu_s, left()));
        show();
    }

    /// It ended before it heard what it was to do: as if it had not been started.
    void withdrawn(std::size_t job) { std::erase(under_way_, job); }

private:
    std::string left() const
    {
        if (expected_done_ <= 0 || done_ == runs_.size()) return "";
        return "   ETA " + clock_time(std::max(0.0, expected_left_) * spent_ / expected_done_ / slots_);
    }

    void show() const
    {
        if (!terminal_ || under_way_.empty()) return;
        std::string names;
        for (const std::size_t job : under_way_) names += (names.empty() ? "" : ", ") + runs_[job]->label;
        say("\r\033[K  running " + names);
    }

    std::vector<const StudyRun*> runs_;
    int slots_;
    bool terminal_;
    std::vector<std::size_t> under_way_;
    std::size_t done_ = 0;
    double expected_left_ = 0, expected_done_ = 0, spent_ = 0;
};

Real expected_seconds(const solver::Problem& problem, const ParticleCount& counted)
{
    const Forecast f = forecast(problem, counted);
    const Real work = f.particle_steps;
    constexpr Real start = 0.05; // s, reading and seeding
    return std::isfinite(work) ? start + work / assumed_steps_per_s(problem.numerics) : start;
}

/// One number for all parts of a run that was stopped and resumed.
io::JobRecord joined_record(const StudyRun& run, const JobEnd& end, const std::optional<io::JobRecord>& before)
{
    io::JobRecord record{CLEAVE_VERSION, end.exit_code, end.over_limit, run.limit, end.cpu_s, end.wall_s, end.peak_rss};
    if (before) {
        record.cpu_s += before->cpu_s;
        record.wall_s += before->wall_s;
        record.peak_rss = std::max(record.peak_rss, before->peak_rss);
    }
    return record;
}

/// The part of a run that was stopped with a checkpoint, to be resumed.
std::optional<io::JobRecord> stopped_part(const StudyRun& run)
{
    std::optional<io::JobRecord> record = io::read_job_record(record_path(run));
    if (record && (record->exit_code != exit_stopped || record->version != CLEAVE_VERSION || !same_case(run)))
        record.reset();
    return record;
}
} // namespace

std::string directory_name(const std::string& label)
{
    std::string name;
    for (const char c : label) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                           c == '+' || c == '=' || c == '_';
        if (plain)
            name += c;
        else if (!name.empty() && name.back() != '-')
            name += '-';
    }
    while (!name.empty() && name.back() == '-') name.pop_back();
    return name.empty() || name.front() == '.' ? "run" + name : name;
}

std::string new_directory_name(const std::string& label, std::vector<std::string>& in_use)
{
    const std::string plain = directory_name(label);
    std::string name = plain;
    for (int n = 2; std::find(in_use.begin(), in_use.end(), name) != in_use.end(); ++n)
        name = fmt::format("{}-{}", plain, n);
    in_use.push_back(name);
    return name;
}

void prepare_runs(std::vector<StudyRun>& runs)
{
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
        StudyRun& run = runs[i];
        try {
            io::Case read = io::read_case_with_warnings(run.file, run.overrides);
            run.problem = std::move(read.problem);
            run.resolved = std::move(read.resolved);
        } catch (const core::InputError& error) {
            run.not_applicable = error.what();
        }
    });
}

void expect_costs(const std::vector<StudyRun*>& runs)
{
    std::map<std::string, std::size_t> number;
    std::vector<std::size_t> grid_of;
    std::vector<const solver::Problem*> grids;
    for (const StudyRun* run : runs) {
        const auto [known, is_new] = number.try_emplace(grid_sections(run->resolved), grids.size());
        grid_of.push_back(known->second);
        if (is_new) grids.push_back(&run->problem);
    }
    std::vector<ParticleCount> counted(grids.size());
    tbb::parallel_for(std::size_t{0}, grids.size(), [&](std::size_t g) { counted[g] = count_particles(*grids[g]); });
    for (std::size_t i = 0; i < runs.size(); ++i) {
        runs[i]->expected_s = expected_seconds(runs[i]->problem, counted[grid_of[i]]);
        if (runs[i]->limit > 0) runs[i]->expected_s = std::min(runs[i]->expected_s, runs[i]->limit);
    }
}

std::optional<io::JobRecord> finished_run(const StudyRun& run, bool whole_cost)
{
    std::optional<io::JobRecord> record = io::read_job_record(record_path(run));
    if (!whole_cost && (!record || !settled(*record, run.limit))) record = record_of_other(run);
    if (!record || record->version != CLEAVE_VERSION || !settled(*record, run.limit) || !same_case(run)) return {};
    return record;
}

std::vector<std::string> run_arguments(const StudyRun& run, const StudyOptions& options)
{
    std::vector<std::string> words{
        "run",        run.file.string(), "-o", run.directory.string(), "--threads", std::to_string(options.threads),
        "--no-frames"};
    for (const std::string& one : run.overrides) {
        words.emplace_back("--set");
        words.push_back(one);
    }
    const bool goes_on = stopped_part(run) || (!options.whole_cost && same_case(run));
    words.emplace_back(goes_on && !options.again ? "--resume" : "--force");
    return words;
}

PoolEnd run_study(const StudyOptions& options, std::vector<StudyRun>& runs)
{
    std::vector<StudyRun*> to_do;
    for (StudyRun& run : runs) {
        if (run.resolved.empty()) continue;
        if (!options.again) run.record = finished_run(run, options.whole_cost);
        if (!run.record) to_do.push_back(&run);
    }
    expect_costs(to_do);
    std::vector<Job> jobs;
    std::vector<std::optional<io::JobRecord>> before;
    for (const StudyRun* run : to_do) {
        before.push_back(options.again ? std::nullopt : stopped_part(*run));
        io::make_directory(run->directory);
        const Real spent = before.back() ? before.back()->cpu_s : 0;
        jobs.push_back({run_arguments(*run, options), fs::path(run->directory.string() + ".log"),
                        run->limit > 0 ? std::max(Real(1), run->limit - spent) : 0});
    }
    // A record of an earlier state must not survive a crash of this one.
    for (std::size_t i = 0; i < to_do.size(); ++i)
        if (!before[i]) fs::remove(record_path(*to_do[i]));
    Progress progress({to_do.begin(), to_do.end()}, options.jobs);
    PoolEvents events;
    events.started = [&](std::size_t job) { progress.started(job); };
    events.ended = [&](std::size_t job, const JobEnd& end) {
        StudyRun& run = *to_do[job];
        if (end.exit_code == -SIGTERM) { // before it listened to signals
            run.record = before[job];
            return progress.withdrawn(job);
        }
        run.record = joined_record(run, end, before[job]);
        io::write_job_record(record_path(run), *run.record);
        progress.ended(job);
    };
    return run_jobs(jobs, options.jobs, options.walltime, events);
}
} // namespace app
