/// Files of a run that are numbered by step or frame: their names, for those who write, find and remove them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace io
{
/// <folder>/<begin><number><end>, and a list of them beside.
struct NumberedFiles
{
    const char* folder; // in the result directory
    const char* begin;
    int digits; // at least
    const char* end;
    const char* list; // file that names them; empty: none

    std::string name(std::int64_t number) const;
    /// Number in a file's name, -1 if it is none of these.
    std::int64_t number(const std::filesystem::path& path) const;
};

/// Paths of those in a folder, the largest number first; none if there is no such folder.
std::vector<std::filesystem::path> newest_first(const std::filesystem::path& folder, const NumberedFiles& kind);

/// Remove what killed writers left: temporaries of these files in a folder.
void remove_temporaries(const std::filesystem::path& folder, const NumberedFiles& kind);

/// Remove those of a result directory with their list and temporaries, and the folder if nothing else is in it.
void remove_all(const std::filesystem::path& directory, const NumberedFiles& kind);
} // namespace io
