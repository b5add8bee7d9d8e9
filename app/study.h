/// Many runs of cases in a local pool, skipping those that are finished: what charts and sweeps have in common.
#pragma once

#include "app/run_pool.h"
#include "io/job_record.h"
#include "solver/problem.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app
{
struct StudyRun
{
    std::string label; // for people
    std::filesystem::path file;
    std::vector<std::string> overrides;
    std::filesystem::path directory;
    Real limit = 0; // s, processor time; 0: none

    // After prepare_runs.
    std::string resolved;       // the case with every default; empty: the settings do not go together
    std::string not_applicable; // why
    solver::Problem problem;
    // After run_study; of what was finished before there is no expectation.
    Real expected_s = 0;                      // s, rough processor time, only for the time that is left
    std::optional<io::JobRecord> record = {}; // nothing: not run yet
};

struct StudyOptions
{
    int jobs = 1;                   // at a time
    int threads = 1;                // of each
    bool whole_cost = false;        // a run cut off by a crash starts anew, so that its cost is known
    bool again = false;             // repeat finished runs
    std::optional<double> walltime; // s
};

/// "nodal h/2" as a name for a directory.
std::string directory_name(const std::string& label);
/// The same, with a number behind it if it is in use; from here on it is.
std::string new_directory_name(const std::string& label, std::vector<std::string>& in_use);

/// Read the case of every run with its overrides: fills in `resolved` or `not_applicable`, and `problem`.
void prepare_runs(std::vector<StudyRun>& runs);

/// Fill in `expected_s` of prepared runs. Those that differ in their methods share a grid, which is counted once:
/// counting takes seconds.
void expect_costs(const std::vector<StudyRun*>& runs);

/// The record of a finished run of the same resolved case with the same program version, if the directory holds one.
///
/// @param whole_cost  only runs of a pool count, since only their processor time is known; else also one that was
///                    started by hand or by a queue
std::optional<io::JobRecord> finished_run(const StudyRun& run, bool whole_cost);

/// What the program was called with for one run.
std::vector<std::string> run_arguments(const StudyRun& run, const StudyOptions& options);

/// Run what is not finished, printing a line for each; fills in `record`.
PoolEnd run_study(const StudyOptions& options, std::vector<StudyRun>& runs);
} // namespace app
