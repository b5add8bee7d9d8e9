/// What the command line of `cleave run` says.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace app
{
struct RunOptions
{
    std::string file;
    std::string directory; // empty: results/<name of the case>
    std::vector<std::string> overrides;
    int threads = 0; // 0: all
    bool resume = false;
    bool force = false;
    bool no_frames = false;         // only the history, run.json and checkpoints
    std::optional<double> walltime; // s
};
} // namespace app
