/// Entry point: reads the command line, runs one command, turns errors into exit codes (docs: design, section 1).
#include "app/commands.h"
#include "app/exit_code.h"

#include <CLI/CLI.hpp>

#ifdef __GLIBC__
#include <malloc.h>
#endif

int main(int argc, char** argv)
{
#ifdef __GLIBC__
    // Columns that exist only while results are written go back to the system; the allocator's own threshold grows with
    // the first of them that is freed, and then they stay.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
    CLI::App program{"Cleave: material point method for ductile crack evolution", "cleave"};
    program.require_subcommand(1);
    program.set_version_flag("--version", "cleave " CLEAVE_VERSION);
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
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& problem) {
        // Also the way out of --help and --version, which are no mistakes.
        return program.exit(problem) == 0 ? app::exit_done : app::exit_bad_input;
    }
    return app::run_reporting_errors(chosen);
}
