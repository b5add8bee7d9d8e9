/// `cleave chart`: error against cost for every choice, and advice from what was measured.
#include "app/advise.h"
#include "app/chart.h"
#include "app/chart_page.h"
#include "app/commands.h"
#include "app/exit_code.h"
#include "app/hardware_threads.h"
#include "app/leave_one_out.h"
#include "app/log.h"
#include "app/shell_word.h"
#include "app/source_tree.h"
#include "app/stop_request.h"
#include "app/walltime_option.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/diagnostics.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace app
{
namespace
{
namespace fs = std::filesystem;

struct Options
{
    std::string suite;
    std::string directory;
    std::vector<std::string> scenes; // empty: all
    bool quick = false;
    StudyOptions study;

    std::string advise; // a case; empty: chart
    bool leave_one_out = false;
    bool summary = false;
    std::string from; // table to advise from
    std::vector<std::string> without;
    std::vector<std::string> overrides;
    std::string error;
    std::optional<Real> length;
};

/// 0.02 of "2%" or "0.02".
Real wanted_error(const std::string& text)
{
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const std::string rest = end;
    const bool percent = rest == "%" || rest == " %";
    const double share = percent ? value / 100 : value;
    if (end == text.c_str() || (!percent && !rest.empty()) || !(share > 0 && share < 1))
        throw core::InputError(
            fmt::format("--error '{}': expected a share above 0 and below 1, such as 2% or 0.02{}", text,
                        rest.empty() && value >= 1 && value < 100 ? fmt::format("; did you mean {}%?", value) : ""));
    return share;
}

fs::path suite_file(const Options& options)
{
    if (!options.suite.empty()) return options.suite;
    const fs::path name = fs::path("cases/chart") / (options.quick ? "quick.toml" : "full.toml");
    if (const std::optional<fs::path> found = source_file(name)) return *found;
    throw core::InputError(fmt::format("{} is not beside this program: name a suite", name.string()));
}

/// @error core::InputError for one that is not there
void require_scenes(const char* source, const std::vector<std::string>& wanted, const std::vector<std::string>& names)
{
    for (const std::string& name : wanted)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw core::InputError(fmt::format("{} has no scene '{}'{}\nscenes: {}", source, name,
                                               io::nearest_hint(name, names, "; "), io::joined(names)));
}

void keep_scenes(const std::vector<std::string>& wanted, io::Suite& suite)
{
    if (wanted.empty()) return;
    std::vector<std::string> names;
    for (const io::Scene& scene : suite.scenes) names.push_back(scene.name);
    require_scenes("the suite", wanted, names);
    std::erase_if(suite.scenes, [&](const io::Scene& scene) {
        return std::find(wanted.begin(), wanted.end(), scene.name) == wanted.end();
    });
}

fs::path picture(const io::Scene& scene, const fs::path& directory, const char* kind)
{
    return directory / "plots" / (directory_name(scene.name) + kind);
}

/// Pictures by the Python script; without it or its packages the chart goes on.
void draw(const Chart& chart, const fs::path& directory)
{
    const std::optional<fs::path> script = source_file("tools/plot_chart.py");
    const fs::path log = directory / "plots.log", plots = directory / "plots";
    io::write_file(log, "");
    for (const io::Scene& scene : chart.suite.scenes)
        for (const char* kind : {".svg", ".png"}) fs::remove(picture(scene, directory, kind)); // of an earlier chart
    const auto word = [](const fs::path& path) { return shell_word(path.string()); };
    const std::string command = script ? fmt::format("/usr/bin/python3 {} {} -o {} > {} 2>&1", word(*script),
                                                     word(directory / "chart.csv"), word(plots), word(log))
                                       : "false";
    if (script && std::system(command.c_str()) == 0) return;
    fmt::print(stderr, "no pictures: {}\nThe tables are complete.\n",
               !script ? "tools/plot_chart.py is not beside this program"
                       : fmt::format("tools/plot_chart.py needs python3-matplotlib (tools/install_packages plot); it "
                                     "said, in {}:\n{}",
                                     log.string(), io::read_file(log)));
}

std::map<std::string, std::string> pictures(const Chart& chart, const fs::path& directory)
{
    std::map<std::string, std::string> all;
    for (const io::Scene& scene : chart.suite.scenes)
        if (const fs::path file = picture(scene, directory, ".svg"); fs::exists(file)) {
            const std::string text = io::read_file(file);
            all[scene.name] = text.substr(std::min(text.find("<svg"), text.size())); // without the XML declaration
        }
    return all;
}

std::map<std::string, std::string> titles(const Chart& chart)
{
    std::map<std::string, std::string> all;
    for (std::size_t i = 0; i < chart.points.size(); ++i) {
        const io::Scene& scene = chart.suite.scenes[chart.points[i].scene];
        const std::string& title = scene.title.empty() ? chart.runs[i].problem.title : scene.title;
        all.try_emplace(scene.name, title.empty() ? scene.name : fmt::format("{}: {}", scene.name, title));
    }
    return all;
}

int chart(const Options& options)
{
    io::Suite suite = io::read_suite(suite_file(options));
    keep_scenes(options.scenes, suite);
    const fs::path directory = !options.directory.empty()
                                   ? fs::path(options.directory)
                                   : fs::path("results") / (options.quick ? "chart-quick" : "chart");
    catch_stop_signals();
    Chart chart = plan_chart(std::move(suite), directory);
    std::size_t left_out = 0;
    for (const ChartRun& point : chart.points) left_out += point.row.status == "not applicable";
    say(fmt::format("{} scenes, {} settings that differ, {} not applicable; {} runs at a time, results in {}\n",
                    chart.suite.scenes.size(), chart.points.size() - left_out, left_out, options.study.jobs,
                    directory.string()));
    io::make_directory(directory);
    const PoolEnd end = run_study(options.study, chart.runs);
    const std::vector<io::ChartRow> rows = chart_rows(chart);
    io::write_chart(directory / "chart.csv", rows);
    draw(chart, directory);
    io::write_file(directory / "chart.html",
                   chart_page(chart.suite.title.empty() ? "Error against cost" : chart.suite.title, rows, titles(chart),
                              pictures(chart, directory)));
    io::write_file(directory / "chart.md", chart_markdown(rows));
    say(fmt::format("\n{}\n{} and chart.csv, chart.md{}\n", chart_text(rows), (directory / "chart.html").string(),
                    fs::exists(directory / "plots") ? ", plots/" : ""));
    if (end == PoolEnd::all_done) return exit_done;
    say("stopped; the same command goes on\n");
    return exit_stopped;
}

fs::path measured_table(const Options& options)
{
    if (!options.from.empty())
        return fs::is_directory(options.from) ? fs::path(options.from) / "chart.csv" : fs::path(options.from);
    if (const std::optional<fs::path> found = source_file("docs/accuracy.csv")) return *found;
    throw core::InputError("docs/accuracy.csv is not beside this program: give --from DIR of a chart");
}

std::vector<io::ChartRow> measured(const Options& options)
{
    std::vector<io::ChartRow> rows = io::read_chart(measured_table(options));
    for (io::ChartRow& row : rows) row.file = here_or_source(row.file).string();
    return rows;
}

void check_scenes(const std::vector<std::string>& wanted, const std::vector<io::ChartRow>& rows)
{
    std::vector<std::string> names;
    for (const io::ChartRow& row : rows)
        if (names.empty() || names.back() != row.scene) names.push_back(row.scene);
    require_scenes("the chart", wanted, names);
}

int summary(const Options& options)
{
    fmt::print("{}", chart_text(measured(options)));
    return exit_done;
}

int advice(const Options& options)
{
    const Real error = wanted_error(options.error);
    const std::vector<io::ChartRow> rows = measured(options);
    check_scenes(options.without, rows);
    if (options.leave_one_out) {
        fmt::print("{}", leave_one_out_text(leave_one_out(rows, error), error));
        return exit_done;
    }
    const AdviceRequest request{options.advise, options.overrides, error, options.length, options.without};
    const Advised found = advise(request, rows);
    if (!found.advice && found.asked_mm > 0)
        throw core::InputError(
            fmt::format("{:.3g} % on scenes like {} asks for cells of {:.3g} mm, {:.3g} across the {:.4g} mm to be "
                        "resolved: no grid of at most {:.0f} million cells has them\n--length gives another "
                        "length to be resolved",
                        100 * error, options.advise, found.asked_mm, found.length_mm / found.asked_mm, found.length_mm,
                        most_cells / 1e6));
    if (!found.advice)
        throw core::InputError(
            fmt::format("no charted method is expected to reach {:.3g} % on scenes like {}: the chart "
                        "has no run that accurate, and errors that do not fall with the cell cannot be "
                        "extrapolated",
                        100 * error, options.advise));
    fmt::print("{}", advice_text(request, *found.advice));
    return exit_done;
}
} // namespace

void add_chart(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand(
        "chart", "Error against cost of every choice on scenes with known answers; advice from what was measured");
    const auto options = std::make_shared<Options>();
    options->study.jobs = hardware_threads();
    options->study.whole_cost = true;
    command->add_option("SUITE", options->suite,
                        "suite file (default: cases/chart/full.toml, with --quick quick.toml)");
    command->add_flag("--quick", options->quick, "the quick suite: 4 to 12 minutes on two cores, by their speed");
    command->add_option("-o,--output", options->directory, "directory (default: results/chart or results/chart-quick)");
    command->add_option("--scene", options->scenes, "only this scene; may be repeated")->allow_extra_args(false);
    command->add_option("--jobs", options->study.jobs, "runs at a time, one thread each (default: all threads)")
        ->check(CLI::Range(1, 1024));
    add_walltime(*command, options->study.walltime,
                 "stop with checkpoints and exit code 75 after this time; the same command goes on");
    command->add_flag("--again", options->study.again, "repeat finished runs, too");
    CLI::Option* advised =
        command->add_option("--advise", options->advise, "run nothing: settings for this case from what was measured");
    CLI::Option* left_out = command->add_flag("--leave-one-out", options->leave_one_out,
                                              "run nothing: advise each charted scene from the others, and compare");
    CLI::Option* summed =
        command->add_flag("--summary", options->summary, "run nothing: the table of a chart, scene by scene");
    command->add_option("--error", options->error, "wanted relative error, such as 2%");
    command->add_option("--from", options->from, "chart.csv, or directory of a chart (default: docs/accuracy.csv)");
    command->add_option("--without", options->without, "do not learn from this scene; may be repeated")
        ->allow_extra_args(false)
        ->excludes(left_out);
    command->add_option("--length", options->length, "mm that the cells have to resolve in the case (default: guessed)")
        ->check(CLI::PositiveNumber);
    command->add_option("--set", options->overrides, "key=value for the case to advise; may be repeated")
        ->allow_extra_args(false);
    summed->excludes(advised)->excludes(left_out);
    command->callback([&chosen, options, advised, left_out] {
        const bool advise = advised->count() > 0 || left_out->count() > 0;
        if (advise && options->error.empty()) throw CLI::ValidationError("--error", "is needed, such as --error 2%");
        chosen = [options, advise] {
            return options->summary ? summary(*options) : advise ? advice(*options) : chart(*options);
        };
    });
}
} // namespace app
