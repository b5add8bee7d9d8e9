/// Run the built program as a user does.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace test
{
struct Outcome
{
    int exit_code = -1; // minus the signal if one ended it
    std::string output; // standard output and error
};

/// Start `cleave arguments...`, its output going to a file; returns the process id.
pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& output);
Outcome wait_for(pid_t process, const std::filesystem::path& output);
Outcome run(const std::vector<std::string>& arguments);

std::string contents(const std::filesystem::path& file);
/// Files below a directory, by relative path, sorted.
std::vector<std::string> files_below(const std::filesystem::path& directory);
} // namespace test
