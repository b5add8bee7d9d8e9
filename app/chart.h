/// A chart: the runs of a suite, and the table they give.
#pragma once

#include "app/study.h"
#include "io/chart_file.h"
#include "io/suite.h"

namespace app
{
/// One run of a chart: what to run, and its row without what the run will tell.
struct ChartRun
{
    std::size_t scene = 0; // index into Suite::scenes
    io::ChartRow row;
};

struct Chart
{
    io::Suite suite;
    std::vector<ChartRun> points;
    std::vector<StudyRun> runs; // one per point
};

/// Every product of every scene, and the default of the scene; settings that resolve to the same case appear once,
/// those that do not go together stay in the table as not applicable.
///
/// @param directory  runs are put below it: runs/<scene>/<setting>
Chart plan_chart(io::Suite suite, const std::filesystem::path& directory);

/// Error of a run, or why there is none.
struct Outcome
{
    std::string status; // as io::ChartRow::status
    std::string reason;
    Real error = io::ChartRow::none;
    Real stability = io::ChartRow::none;
};
Outcome outcome_of(const io::Scene& scene, const io::JobRecord& record, const std::filesystem::path& run_directory);

/// The rows of the chart from what has been run, fronts marked.
std::vector<io::ChartRow> chart_rows(const Chart& chart);

/// Mark the rows that no other row of their scene beats in both error and processor time, and work out
/// `cost_over_front`. Only rows with status done take part.
void mark_fronts(std::vector<io::ChartRow>& rows);
} // namespace app
