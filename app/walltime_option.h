/// The option --walltime of the commands that run cases.
#pragma once

#include <optional>
#include <string>

namespace CLI
{
class App;
}

namespace app
{
/// Register --walltime T, read by parse_walltime into `seconds`, which must outlive `command`.
void add_walltime(CLI::App& command, std::optional<double>& seconds, const std::string& meaning);
} // namespace app
