/// `cleave info`: versions, build, machine.
#include "app/commands.h"
#include "app/instruction_set.h"
#include "io/library_versions.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thread>

namespace app
{
namespace
{
int print_info()
{
    fmt::print("cleave     {} ({})\n", CLEAVE_VERSION, CLEAVE_BUILD_TYPE);
    fmt::print("compiler   {}\n", compiler_name());
    fmt::print("machine    {}, {} threads\n", instruction_set(), std::thread::hardware_concurrency());
    fmt::print("libraries  {}\n", io::library_versions());
    fmt::print("units      mm, g, ms; so N, MPa, mJ\n");
    return 0;
}
} // namespace

void add_info(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("info", "Versions, build and machine");
    command->callback([&chosen] { chosen = print_info; });
}
} // namespace app
