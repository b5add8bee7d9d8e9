#include "app/sweep_table.h"

#include "app/exit_code.h"
#include "app/shell_word.h"
#include "io/csv.h"
#include "io/diagnostics.h"
#include "io/run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app
{
namespace
{
constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

/// A title within a comment: no line end may leave it.
std::string one_line(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
}

std::string value_text(const io::Measure& measure)
{
    if (const auto* text = std::get_if<std::string>(&measure.value)) return *text;
    const Real value = std::get<Real>(measure.value);
    return std::isfinite(value) ? fmt::format("{:.7g}", value) : "";
}

std::string status_of(const StudyRun& run)
{
    if (run.resolved.empty()) return "not applicable";
    if (!run.record) return "pending";
    if (run.record->over_limit) return "over limit";
    if (run.record->exit_code == exit_stopped) return "stopped";
    return run.record->exit_code == exit_done ? "done" : "failed";
}

const std::string* find_measure(const SweepRow& row, const std::string& name)
{
    for (const auto& [own, value] : row.measures)
        if (own == name) return &value;
    return nullptr;
}

Real relative_error(const SweepRow& row, const io::SweepTarget& target)
{
    const std::string* text = find_measure(row, target.measure);
    return !text || text->empty() ? nan : std::strtod(text->c_str(), nullptr) / target.value - 1;
}

SweepRow row_of(const io::Sweep& sweep, const StudyRun& run)
{
    SweepRow row;
    row.label = run.label;
    row.status = status_of(run);
    row.set = run.overrides;
    row.distance = nan;
    if (run.resolved.empty()) row.reason = run.not_applicable.substr(0, run.not_applicable.find('\n'));
    if (run.record) row.wall_s = run.record->wall_s;
    if (!run.record || !std::filesystem::exists(run.directory / "run.json")) return row;
    const io::RunRecord record = io::read_run_record(run.directory / "run.json");
    if (row.status != "done") row.reason = record.exit_reason;
    for (const io::Measure& measure : record.measures) row.measures.emplace_back(measure.name, value_text(measure));
    if (sweep.targets.empty() || row.status != "done") return row;
    row.distance = 0;
    for (const io::SweepTarget& target : sweep.targets)
        if (target.weight > 0) row.distance += target.weight * std::abs(relative_error(row, target));
    return row;
}
} // namespace

std::vector<SweepRow> sweep_rows(const io::Sweep& sweep, const std::vector<StudyRun>& runs)
{
    std::vector<SweepRow> rows;
    for (const StudyRun& run : runs) rows.push_back(row_of(sweep, run));
    const auto key = [](const SweepRow& row) {
        return std::isfinite(row.distance) ? row.distance : std::numeric_limits<Real>::infinity();
    };
    std::stable_sort(rows.begin(), rows.end(), [&](const SweepRow& a, const SweepRow& b) { return key(a) < key(b); });
    return rows;
}

std::string sweep_csv(const std::vector<SweepRow>& rows)
{
    std::vector<std::string> names; // in the order they first appear
    for (const SweepRow& row : rows)
        for (const auto& measure : row.measures)
            if (std::find(names.begin(), names.end(), measure.first) == names.end()) names.push_back(measure.first);
    std::vector<std::string> cells{"run", "status", "distance", "wall_s"};
    cells.insert(cells.end(), names.begin(), names.end());
    cells.insert(cells.end(), {"overrides", "reason"});
    std::string text = io::csv_line(cells) + "\n";
    for (const SweepRow& row : rows) {
        cells = {row.label, row.status, std::isfinite(row.distance) ? fmt::format("{:.6g}", row.distance) : "",
                 fmt::format("{:.3f}", row.wall_s)};
        for (const std::string& name : names) {
            const std::string* value = find_measure(row, name);
            cells.push_back(value ? *value : "");
        }
        cells.push_back(io::joined(row.set, "; "));
        cells.push_back(row.reason);
        text += io::csv_line(cells) + "\n";
    }
    return text;
}

std::string sweep_text(const io::Sweep& sweep, const std::vector<SweepRow>& rows)
{
    std::size_t width = 4;
    for (const SweepRow& row : rows) width = std::max(width, row.label.size());
    std::string text = fmt::format("{:<{}}  {:<14} {:>9}", "run", width, "status", "distance");
    for (const io::SweepTarget& target : sweep.targets) text += fmt::format(" {:>16}", target.measure);
    if (!sweep.targets.empty()) {
        text += fmt::format("\n{:<{}}  {:<14} {:>9}", "(wanted)", width, "", "");
        for (const io::SweepTarget& target : sweep.targets) text += fmt::format(" {:>16.6g}", target.value);
    }
    for (const SweepRow& row : rows) {
        text += fmt::format("\n{:<{}}  {:<14} {:>9}", row.label, width, row.status,
                            std::isfinite(row.distance) ? fmt::format("{:.4f}", row.distance) : "-");
        for (const io::SweepTarget& target : sweep.targets) {
            const std::string* value = find_measure(row, target.measure);
            if (!value || value->empty())
                text += fmt::format(" {:>16}", value ? "not reached" : "-");
            else
                text += fmt::format(" {:>9.5g}{:>+6.1f}%", std::strtod(value->c_str(), nullptr),
                                    100 * relative_error(row, target));
        }
    }
    return text + "\n";
}

std::string slurm_script(const io::Sweep& sweep, const std::vector<StudyRun>& runs, const std::string& program)
{
    std::string text =
        fmt::format("#!/bin/sh\n"
                    "#SBATCH --job-name=cleave-sweep\n"
                    "#SBATCH --array=0-{}\n"
                    "#SBATCH --cpus-per-task={}\n"
                    "#SBATCH --time=12:00:00\n"
                    "#SBATCH --signal=B:USR1@300\n"
                    "#SBATCH --requeue\n"
                    "# {}: {} runs of {}. Afterwards `cleave sweep` with the same options makes the table.\n"
                    "# The run writes a checkpoint when the time is nearly over, and the task queues again.\n"
                    "cd {} || exit 1\n"
                    "case $SLURM_ARRAY_TASK_ID in\n",
                    runs.size() - 1, sweep.threads, sweep.title.empty() ? "sweep" : one_line(sweep.title), runs.size(),
                    sweep.file.string(), shell_word(std::filesystem::current_path().string()));
    StudyOptions options;
    options.threads = sweep.threads;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::vector<std::string> words = run_arguments(runs[i], options);
        words.back() = "--resume"; // starts at time 0 where there is nothing yet
        std::string line = fmt::format("{}) set --", i);
        for (const std::string& word : words) line += " " + shell_word(word);
        text += line + " ;;\n";
    }
    return text + fmt::format("esac\n"
                              "{} \"$@\" & run=$!\n"
                              "trap 'kill -USR1 $run' USR1\n"
                              "wait $run; code=$?\n"
                              "[ $code -le 128 ] || {{ wait $run; code=$?; }} # the signal ended the first wait\n"
                              "[ $code -ne 75 ] || scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\"\n"
                              "exit $code\n",
                              shell_word(program));
}
} // namespace app
