#include "app/walltime_option.h"

#include "app/stop_request.h"

#include <CLI/CLI.hpp>

namespace app
{
void add_walltime(CLI::App& command, std::optional<double>& seconds, const std::string& meaning)
{
    command
        .add_option_function<std::string>(
            "--walltime",
            [&seconds](const std::string& text) {
                seconds = parse_walltime(text);
                if (!seconds)
                    throw CLI::ValidationError("--walltime", "'" + text +
                                                                 "': expected seconds (90), minutes (45min), hours "
                                                                 "(2h) or 3:50:00");
            },
            meaning)
        ->type_name("T");
}
} // namespace app
