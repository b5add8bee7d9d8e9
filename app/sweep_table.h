/// The table of a sweep: every run with its overrides, measures and distance to the targets.
#pragma once

#include "app/study.h"
#include "io/sweep.h"

namespace app
{
struct SweepRow
{
    std::string label;
    std::string status; // done, failed, over limit, stopped, not applicable, pending
    std::string reason;
    std::vector<std::pair<std::string, std::string>> measures; // names and values as text; empty value: not reached
    Real distance = 0; // 1, sum of weight times relative error; NaN: no targets, or one of them was not reached
    Real wall_s = 0;
    std::vector<std::string> set;
};

/// Rows of all runs, the nearest first, then those without distance in the order of the sweep.
std::vector<SweepRow> sweep_rows(const io::Sweep& sweep, const std::vector<StudyRun>& runs);

std::string sweep_csv(const std::vector<SweepRow>& rows);
/// For the terminal: distances, and the relative error of each target.
std::string sweep_text(const io::Sweep& sweep, const std::vector<SweepRow>& rows);

/// A Slurm job array, one task per run, each resuming what an earlier call left.
///
/// @param program  what to call, such as the absolute path of ./cleave
std::string slurm_script(const io::Sweep& sweep, const std::vector<StudyRun>& runs, const std::string& program);
} // namespace app
