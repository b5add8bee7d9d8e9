/// `cleave point CASE`: the material law alone, along a path of strains and stresses.
#include "app/commands.h"
#include "app/point_report.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/point_case.h"
#include "io/point_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace app
{
namespace
{
namespace fs = std::filesystem;

struct Options
{
    std::string file;
    std::string directory;
    std::vector<std::string> overrides;
};

/// Unlike a run a path takes no time worth keeping: its files are replaced, but those of a run are not mixed with.
fs::path point_directory(const Options& options)
{
    const fs::path directory =
        options.directory.empty() ? fs::path("results") / fs::path(options.file).stem() : fs::path(options.directory);
    if (fs::exists(directory / "run.json"))
        throw core::InputError(fmt::format("{} holds a run: choose another -o.", directory.string()));
    return directory;
}

void write_files(const fs::path& directory, const io::PointCase& read, const std::vector<solver::PointState>& history)
{
    io::make_directory(directory);
    io::write_file(directory / "resolved.toml", read.resolved);
    io::write_file(directory / "point.csv", io::point_csv(history));
    io::write_file(directory / "point.svg", point_charts(history));
}

int point(const Options& options)
{
    const io::PointCase read = io::read_point_case(options.file, options.overrides);
    const fs::path directory = point_directory(options);
    std::vector<solver::PointState> history;
    try {
        solver::follow(read.path, [&](const solver::PointState& state) { history.push_back(state); });
    } catch (const core::NumericalError&) {
        write_files(directory, read, history); // the way there explains the failure
        throw;
    }
    write_files(directory, read, history);
    fmt::print("{}: {}\n{}written      {}\n", options.file, read.title.empty() ? "no title" : read.title,
               point_summary(read.path, history), (directory / "point.{csv,svg}").string());
    return 0;
}
} // namespace

void add_point(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("point", "Drive one material point along a path: the material law without a grid");
    const auto options = std::make_shared<Options>();
    command->add_option("CASE", options->file, "case file with [point]")->required();
    command->add_option("-o,--output", options->directory, "result directory (default: results/<name of the case>)");
    command->add_option("--set", options->overrides, "key=value, such as point.cell=0.5; may be repeated")
        ->allow_extra_args(false);
    command->callback([&chosen, options] { chosen = [options] { return point(*options); }; });
}
} // namespace app
