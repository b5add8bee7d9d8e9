/// Ways to end a run early with a checkpoint: SIGINT, SIGTERM, SIGUSR1, SIGHUP, and the wall-time limit.
#pragma once

#include <optional>
#include <string>

namespace app
{
/// From now on those signals only set a flag, and writing to a closed pipe is an error, not the end. A second SIGINT
/// ends the program at once.
void catch_stop_signals();
bool stop_requested();

/// Seconds of "90", "45min", "2h", "50:00" (mm:ss) or "3:50:00"; nothing of any other text.
std::optional<double> parse_walltime(const std::string& text);
} // namespace app
