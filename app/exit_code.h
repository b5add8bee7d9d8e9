/// Exit codes of the program, and the one place where errors become them.
#pragma once

#include "app/commands.h"

namespace app
{
inline constexpr int exit_done = 0;
inline constexpr int exit_internal = 1; // a mistake of the program
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_numerical = 3;
inline constexpr int exit_file = 4;
inline constexpr int exit_stopped = 75; // with a checkpoint; EX_TEMPFAIL, so that queues start it again

/// Run a command; print what it throws to standard error and return the exit code of its cause.
int run_reporting_errors(const Command& command);
} // namespace app
