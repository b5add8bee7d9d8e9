/// `cleave report DIR`: one HTML page of a finished or running case; `cleave metric DIR`: its measures on one line.
#include "app/commands.h"
#include "app/report_page.h"
#include "io/atomic_file.h"
#include "io/case.h"
#include "io/event_file.h"
#include "io/history_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace app
{
namespace
{
int write_report(const std::filesystem::path& directory)
{
    const std::filesystem::path resolved = directory / "resolved.toml";
    const std::filesystem::path events = directory / "events.csv";
    const Report report{io::read_run_record(directory / "run.json"),
                        io::read_case(resolved),
                        io::read_file(resolved),
                        io::read_history(directory / "history.csv"),
                        std::filesystem::exists(events) ? io::read_events(events)
                                                        : std::vector<std::vector<std::string>>{},
                        io::read_last_particle_frame(directory / io::particle_files.folder, report_fields)};
    const std::filesystem::path page = directory / "report.html";
    io::write_file(page, report_page(report));
    fmt::print("{}\n", page.string());
    return 0;
}

int print_measures(const std::filesystem::path& directory)
{
    fmt::print("{}\n", io::measures_line(io::read_run_record(directory / "run.json")));
    return 0;
}

void add_directory_command(CLI::App& program, Command& chosen, const char* name, const char* what,
                           int (*action)(const std::filesystem::path&))
{
    CLI::App* command = program.add_subcommand(name, what);
    const auto directory = std::make_shared<std::string>();
    command->add_option("DIR", *directory, "result directory of a run")->required();
    command->callback([&chosen, directory, action] { chosen = [directory, action] { return action(*directory); }; });
}
} // namespace

void add_report(CLI::App& program, Command& chosen)
{
    add_directory_command(program, chosen, "report", "Write report.html: curves, pictures, measures, versions",
                          write_report);
}

void add_metric(CLI::App& program, Command& chosen)
{
    add_directory_command(program, chosen, "metric", "Print the measures as one line of JSON", print_measures);
}
} // namespace app
