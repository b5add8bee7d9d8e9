/// `cleave info`: versions, build, machine.
#include "app/commands.h"
#include "app/commit.h"
#include "app/compiler_name.h"
#include "app/hardware_threads.h"
#include "io/library_versions.h"
#include "transfer/kernel_level.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace app
{
namespace
{
int print_info()
{
    fmt::print("cleave     {}, {}\n", version_text(), CLEAVE_BUILD_TYPE);
    fmt::print("compiler   {}\n", compiler_name());
    fmt::print("machine    kernels for {}, {} threads\n", transfer::kernel_level(), hardware_threads());
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
