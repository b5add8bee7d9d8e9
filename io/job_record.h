/// job.json beside a run that a chart or a sweep started: how it ended and what it cost, so that it is not repeated.
#pragma once

#include "core/real.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace io
{
struct JobRecord
{
    std::string version;        // of the program
    int exit_code = 0;          // minus the signal if one ended it
    bool over_limit = false;    // given up at its processor time limit
    Real limit_s = 0;           // s, that limit; 0: none
    Real cpu_s = 0;             // s, processor time of all parts, user and system
    Real wall_s = 0;            // s, of all parts
    std::uint64_t peak_rss = 0; // byte
};

/// @error FileError
void write_job_record(const std::filesystem::path& path, const JobRecord& record);

/// Nothing if the file is missing or was not written by this program.
std::optional<JobRecord> read_job_record(const std::filesystem::path& path);

/// The numbers and texts of run.json by dotted path, such as errors.u or measures.peak_force_N.
class RunNumbers
{
public:
    /// @error FileError if the file is missing or not JSON
    explicit RunNumbers(const std::filesystem::path& run_json);
    ~RunNumbers();
    RunNumbers(RunNumbers&&) noexcept;

    /// NaN where the file has null (not reached); nothing if there is no such number.
    std::optional<Real> number(const std::string& path) const;
    /// The sum where the file has a list (particles per level).
    Real total(const std::string& path) const;
    std::string text(const std::string& path) const;
    /// Dotted paths of all numbers in "measures" and "errors".
    std::string known() const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};
} // namespace io
