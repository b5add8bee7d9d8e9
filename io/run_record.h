/// run.json: what a run was, how fast it went and what came out, for people, sweeps and the report.
#pragma once

#include "solver/problem.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace io
{
/// A named result, such as {"peak_force_N", 8123.0} or {"crack_path", "A-D-C-E"}; NaN: not reached, null in the file.
struct Measure
{
    std::string name;
    std::variant<Real, std::string> value;
};

/// What a measure of the case is to be compared with.
struct Target
{
    std::string name; // of the measure
    Real reference = 0;
    Real error = 0;                // 1, value / reference - 1, the value itself where the reference is 0; NaN: no value
    std::optional<Real> tolerance; // 1, on |error|
};

struct RunRecord
{
    std::string title;
    std::string version;
    std::string commit;             // the program was built from; empty: not known
    std::string status = "running"; // running, done, stopped (with a checkpoint), failed
    std::string exit_reason;        // why it ended; empty while running
    std::string compiler;           // such as "g++ 12.2.0"
    std::string instruction_set;    // of the kernels in use, such as "x86-64-v4"
    int threads = 1;
    Real wall_s = 0, cpu_s = 0;                                // s, wall and processor time of all parts of a run
    std::int64_t steps = 0;                                    // 1
    std::uint64_t particle_steps = 0;                          // 1
    std::uint64_t peak_rss_bytes = 0;                          // byte
    std::vector<std::uint64_t> particles_start, particles_end; // per level
    std::vector<std::string> modelled;                         // what was active and why, one sentence each
    std::vector<Measure> measures;                             // in the order they are to be shown
    std::vector<Target> targets;                               // of those measures that have a reference
    std::vector<solver::Reference> references;                 // published numbers to compare with
};

/// Write the record, atomically; particle_steps_per_s is worked out here.
/// @error FileError
void write_run_record(const std::filesystem::path& path, const RunRecord& record);

/// @error FileError if the file is missing or not a run record
RunRecord read_run_record(const std::filesystem::path& path);

/// Title, status and measures on one line, for sweeps and optimisers.
std::string measures_line(const RunRecord& record);
} // namespace io
