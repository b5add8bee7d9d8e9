/// The commands of the program, one file each: app/command_<name>.cpp.
///
/// A file registers its command with its options; when the command line names it, `chosen` becomes what main runs. A
/// command returns an exit code (0 done, 75 stopped with a checkpoint) or throws an error of core/error.h.
#pragma once

#include <functional>

namespace CLI
{
class App;
}

namespace app
{
using Command = std::function<int()>;

void add_run(CLI::App& program, Command& chosen);
void add_point(CLI::App& program, Command& chosen);
void add_chart(CLI::App& program, Command& chosen);
void add_sweep(CLI::App& program, Command& chosen);
void add_bench(CLI::App& program, Command& chosen);
void add_check(CLI::App& program, Command& chosen);
void add_new(CLI::App& program, Command& chosen);
void add_keys(CLI::App& program, Command& chosen);
void add_info(CLI::App& program, Command& chosen);
void add_report(CLI::App& program, Command& chosen);
void add_metric(CLI::App& program, Command& chosen);
} // namespace app
