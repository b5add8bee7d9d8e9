/// A local pool of child processes: each job is one call of this program, `slots` of them at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace app
{
struct Job
{
    std::vector<std::string> arguments; // of this program, such as {"run", "case.toml", "-o", "out"}
    std::filesystem::path log;          // gets what the child says
    double cpu_limit = 0;               // s of processor time, then it is ended; 0: none
};

struct JobEnd
{
    int exit_code = 0; // minus the signal if one ended it
    bool over_limit = false;
    double cpu_s = 0;           // s, user and system
    double wall_s = 0;          // s
    std::uint64_t peak_rss = 0; // byte
};

enum class PoolEnd
{
    all_done,
    stopped, // by a signal or the wall time: the children were asked to write checkpoints, and ended
};

struct PoolEvents
{
    std::function<void(std::size_t job)> started;
    std::function<void(std::size_t job, const JobEnd&)> ended; // in the order they end
};

/// Run the jobs in order. A stop request (app/stop_request.h) or the end of `walltime` sends SIGTERM to the children
/// and waits for them; so does an error in `events` or in starting one, which is thrown on then. If this process dies
/// the children get SIGTERM, too (Linux).
///
/// @pre catch_stop_signals() was called
/// @error core::FileError if a log cannot be written or no process can be made
PoolEnd run_jobs(const std::vector<Job>& jobs, int slots, std::optional<double> walltime, const PoolEvents& events);
} // namespace app
