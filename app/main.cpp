/// Entry point: reads the command line, runs one command, turns errors into exit codes (docs: design, section 1).
#include "app/commands.h"
#include "app/commit.h"
#include "app/exit_code.h"
#include "io/diagnostics.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace
{
/// What to say if `name` is no command; nothing if it is one.
std::string complaint(const CLI::App& program, const std::string& name)
{
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), name) != names.end()) return "";
    return fmt::format("there is no command '{}'{}\ncommands: {}\n", name, io::nearest_hint(name, names, "; "),
                       io::joined(names));
}
} // namespace

int main(int argc, char** argv)
{
#ifdef __GLIBC__
    // Columns that exist only while results are written go back to the system; the allocator's own threshold grows with
    // the first of them that is freed, and then they stay.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
    CLI::App program{"Cleave: material point method for ductile crack evolution", "cleave"};
    program.require_subcommand(1);
    program.set_version_flag("--version", "cleave " + app::version_text());
    app::Command chosen;
    app::add_run(program, chosen);
    app::add_check(program, chosen);
    app::add_point(program, chosen);
    app::add_chart(program, chosen);
    app::add_sweep(program, chosen);
    app::add_bench(program, chosen);
    app::add_new(program, chosen);
    app::add_keys(program, chosen);
    app::add_info(program, chosen);
    app::add_report(program, chosen);
    app::add_metric(program, chosen);
    if (argc > 1 && argv[1][0] != '-')
        if (const std::string text = complaint(program, argv[1]); !text.empty()) {
            std::fputs(text.c_str(), stderr);
            return app::exit_bad_input;
        }
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& problem) {
        // Also the way out of --help and --version, which are no mistakes.
        return program.exit(problem) == 0 ? app::exit_done : app::exit_bad_input;
    }
    return app::run_reporting_errors(chosen);
}
