/// Sweeps: many runs of one case, compared with wanted values.
#pragma once

#include "io/suite.h"

namespace io
{
struct SweepTarget
{
    std::string measure; // of run.json, without "measures."
    Real value = 0;      // in mm-g-ms
    Real weight = 1;     // 1, of its relative error
};

struct Sweep
{
    std::string title;
    std::filesystem::path file;       // the case
    std::vector<std::string> set;     // overrides of every run
    int threads = 1;                  // of each run
    std::optional<Real> limit;        // s, processor time of a run
    std::vector<Setting> runs;        // listed, or every combination
    std::vector<SweepTarget> targets; // empty: nothing to compare with
};

/// @error core::InputError with the text of every error, also those of the case; core::FileError if `file` cannot be
/// read
Sweep read_sweep(const std::filesystem::path& file);
} // namespace io
