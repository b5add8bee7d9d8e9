#include "app/chart.h"

#include "app/choice_name.h"
#include "app/exit_code.h"
#include "app/scene_features.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/case.h"
#include "io/diagnostics.h"
#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace app
{
namespace
{
namespace fs = std::filesystem;

/// One setting of each axis of a product.
struct Combination
{
    std::string label, scheme;                // of all axes; of those that are not resolution
    std::vector<std::string> set, scheme_set; // overrides, without those of the scene
};

void add(Combination& combination, const io::Axis& axis, const io::Setting& setting)
{
    const auto append = [&](std::string& label, std::vector<std::string>& set) {
        label += (label.empty() ? "" : ", ") + setting.label;
        set.insert(set.end(), setting.set.begin(), setting.set.end());
    };
    append(combination.label, combination.set);
    if (!axis.resolution) append(combination.scheme, combination.scheme_set);
}

std::vector<std::string> with(std::vector<std::string> set, const std::vector<std::string>& more)
{
    set.insert(set.end(), more.begin(), more.end());
    return set;
}

void describe(const io::Scene& scene, const solver::Problem& problem, io::ChartRow& row)
{
    const solver::Numerics& n = problem.numerics;
    row.cell_mm = problem.grid.cell;
    row.levels = problem.grid.levels;
    row.finest_mm = problem.grid.cell / std::pow(2.0, problem.grid.levels - 1);
    row.particles_per_cell = problem.grid.particles_per_cell;
    row.formulation = choice_name("formulation", n.formulation);
    row.basis = choice_name("basis", n.basis);
    row.transfer = choice_name("transfer", n.transfer);
    row.stress_update = choice_name("stress_update", n.stress_update);
    row.precision = choice_name("precision", n.precision);
    row.pic_fraction = n.pic_fraction;
    row.cfl = n.cfl;
    if (scene.length) row.length_mm = *scene.length;
}

/// Features belong to the scene, not to the setting: a case without zones is still localised, and a coarse cell must
/// not turn a side of the body into a slab.
void describe_scene(const io::Scene& scene, const solver::Problem& problem, io::ChartRow& row)
{
    const SceneFeatures features = scene_features(problem);
    row.contact = features.contact;
    row.large_motion = features.large_motion;
    row.plastic = features.plastic;
    row.crack = features.crack;
    row.localised = features.localised;
    row.length_mm = scene.length.value_or(features.length);
}

/// Complain now about a result that no run will have, not after a night.
void check_measure(const io::Scene& scene, const std::string& path, const solver::Problem& problem)
{
    std::vector<std::string> known;
    for (const std::string& name : solver::measure_names(problem)) known.push_back("measures." + name);
    for (const solver::Quantity& quantity : problem.quantities)
        if (quantity.reference) known.push_back("errors." + quantity.name);
    const bool of_these = path.starts_with("measures.") || path.starts_with("errors.");
    if (!of_these || std::find(known.begin(), known.end(), path) != known.end()) return;
    throw core::InputError(fmt::format("scene '{}': its runs have no number '{}'{}\nnumbers: {}", scene.name, path,
                                       io::nearest_hint(path, known, "; "), io::joined(known)));
}

/// First line of a complaint without its place: long enough to see what is meant.
std::string first_complaint(const std::string& text)
{
    std::string line = text.substr(0, text.find('\n'));
    if (const std::size_t at = line.find("error: "); at != std::string::npos) line = line.substr(at + 7);
    return line;
}

void plan_scene(const io::Scene& scene, std::size_t number, const fs::path& directory, Chart& chart)
{
    std::vector<Combination> all{{"default", "default", {}, {}}};
    for (const std::vector<io::Axis>& product : scene.products)
        for (Combination& one : io::combinations<Combination>(product, add)) {
            if (one.label.empty()) continue;
            if (one.scheme.empty()) one.scheme = "default";
            all.push_back(std::move(one));
        }
    std::vector<StudyRun> runs, schemes;
    std::map<std::string, std::size_t> scheme_number;
    for (const Combination& one : all) {
        StudyRun run;
        run.label = scene.name + ": " + one.label;
        run.file = scene.file;
        run.overrides = with(scene.set, one.set);
        run.limit = scene.limit;
        runs.push_back(run);
        if (scheme_number.try_emplace(one.scheme, schemes.size()).second) {
            run.overrides = with(scene.set, one.scheme_set);
            schemes.push_back(std::move(run));
        }
    }
    prepare_runs(runs);
    prepare_runs(schemes);
    const std::string default_case = runs.front().resolved; // a copy: the runs are moved away one by one
    if (default_case.empty())
        throw core::InputError(fmt::format("scene '{}' cannot be run:\n{}", scene.name, runs.front().not_applicable));
    const solver::Problem as_it_is = runs.front().problem;
    check_measure(scene, scene.measure, as_it_is);
    if (scene.stable) check_measure(scene, scene.stable->measure, as_it_is);
    std::vector<std::string> seen, directories;
    for (std::size_t i = 0; i < all.size(); ++i) {
        StudyRun& run = runs[i];
        if (!run.resolved.empty() && std::find(seen.begin(), seen.end(), run.resolved) != seen.end()) continue;
        seen.push_back(run.resolved);
        run.directory = directory / "runs" / directory_name(scene.name) / new_directory_name(all[i].label, directories);
        ChartRun point;
        point.scene = number;
        point.row.scene = scene.name;
        point.row.file = scene.file.generic_string();
        point.row.setting = all[i].label;
        const bool own_scheme = schemes[scheme_number.at(all[i].scheme)].resolved == default_case;
        point.row.scheme = own_scheme ? "default" : all[i].scheme;
        point.row.role = run.resolved == default_case ? "default" : own_scheme ? "scheme" : "";
        point.row.overrides = io::joined(all[i].set, "; ");
        point.row.version = CLEAVE_VERSION;
        describe_scene(scene, as_it_is, point.row);
        if (run.resolved.empty()) {
            point.row.status = "not applicable";
            point.row.reason = first_complaint(run.not_applicable);
        } else
            describe(scene, run.problem, point.row);
        chart.points.push_back(std::move(point));
        chart.runs.push_back(std::move(run));
    }
}

std::string last_line(const fs::path& log)
{
    if (!fs::exists(log)) return "";
    std::string text = io::read_file(log);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

/// The number at a path of run.json; a name that is not there is a mistake in the suite.
Real number_of(const io::RunNumbers& numbers, const std::string& path, const fs::path& directory)
{
    if (const std::optional<Real> value = numbers.number(path)) return *value;
    throw core::InputError(fmt::format("{} has no number '{}'\nnumbers there: {}", (directory / "run.json").string(),
                                       path, numbers.known()));
}
} // namespace

Chart plan_chart(io::Suite suite, const fs::path& directory)
{
    Chart chart;
    chart.suite = std::move(suite);
    for (std::size_t i = 0; i < chart.suite.scenes.size(); ++i) plan_scene(chart.suite.scenes[i], i, directory, chart);
    return chart;
}

Outcome outcome_of(const io::Scene& scene, const io::JobRecord& record, const fs::path& run_directory)
{
    Outcome outcome;
    if (record.over_limit) {
        outcome.status = "over limit";
        outcome.reason = fmt::format("not finished after {:.0f} s of processor time", record.limit_s);
        return outcome;
    }
    if (record.exit_code == exit_stopped) {
        outcome.status = "pending";
        return outcome;
    }
    if (record.exit_code != exit_done) {
        outcome.status = "failed";
        outcome.reason = last_line(run_directory.string() + ".log");
        return outcome;
    }
    const io::RunNumbers numbers(run_directory / "run.json");
    const Real value = number_of(numbers, scene.measure, run_directory);
    outcome.error = scene.reference ? std::abs(value - *scene.reference) / std::abs(*scene.reference) : std::abs(value);
    if (scene.stable) outcome.stability = std::abs(number_of(numbers, scene.stable->measure, run_directory));
    if (scene.stable && !(outcome.stability < scene.stable->below)) {
        outcome.status = "unstable";
        outcome.reason =
            fmt::format("{} = {:.3g}, not below {:.3g}", scene.stable->measure, outcome.stability, scene.stable->below);
    } else if (!std::isfinite(outcome.error)) {
        outcome.status = "not reached";
        outcome.reason = scene.measure + " was not reached";
    } else
        outcome.status = "done";
    return outcome;
}

std::vector<io::ChartRow> chart_rows(const Chart& chart)
{
    std::vector<io::ChartRow> rows;
    for (std::size_t i = 0; i < chart.points.size(); ++i) {
        io::ChartRow& row = rows.emplace_back(chart.points[i].row);
        const StudyRun& run = chart.runs[i];
        if (!row.status.empty()) continue;
        if (!run.record) {
            row.status = "pending";
            continue;
        }
        const Outcome outcome = outcome_of(chart.suite.scenes[chart.points[i].scene], *run.record, run.directory);
        row.status = outcome.status;
        row.reason = outcome.reason;
        row.error = outcome.error;
        row.stability = outcome.stability;
        row.exit_code = run.record->exit_code;
        row.cpu_s = run.record->cpu_s;
        row.wall_s = run.record->wall_s;
        row.peak_rss_bytes = static_cast<Real>(run.record->peak_rss);
        if (!fs::exists(run.directory / "run.json")) continue;
        const io::RunNumbers numbers(run.directory / "run.json");
        row.steps = numbers.number("steps").value_or(io::ChartRow::none);
        row.particle_steps = numbers.number("particle_steps").value_or(io::ChartRow::none);
        row.particles = numbers.total("particles.start");
    }
    mark_fronts(rows);
    return rows;
}

void mark_fronts(std::vector<io::ChartRow>& rows)
{
    for (io::ChartRow& row : rows) {
        row.front = 0;
        row.cost_over_front = io::ChartRow::none;
        if (row.status != "done") continue;
        Real cheapest = row.cpu_s;
        for (const io::ChartRow& other : rows)
            if (other.scene == row.scene && other.status == "done" && other.error <= row.error)
                cheapest = std::min(cheapest, other.cpu_s);
        row.cost_over_front = row.cpu_s / cheapest;
        row.front = row.cost_over_front <= 1;
    }
}
} // namespace app
