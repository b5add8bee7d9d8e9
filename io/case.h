/// Reading case files: TOML text in, a valid solver::Problem out, or every error at once.
#pragma once

#include "io/diagnostics.h"
#include "solver/problem.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace io
{
struct Case
{
    solver::Problem problem;
    std::vector<std::string> warnings; // complete texts with file, line and caret
    std::string resolved;              // case file with every default written out, numbers in mm-g-ms
};

/// Read and check a case file.
///
/// @param overrides  "grid.cell=0.5" as given to --set, applied after the file and its includes
/// @error core::InputError with the text of every error; core::FileError if `file` cannot be read
Case read_case_with_warnings(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same, for those who need the Problem only.
solver::Problem read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// What a case says against the keys of its overrides, whatever their values: "unknown key 'cel' in [grid]". What else
/// is wrong with the case is not looked at.
///
/// @return one for each override, nothing where the case knows the key
/// @error core::FileError if `file` cannot be read
std::vector<std::optional<Complaint>> complaints_of_keys(const std::filesystem::path& file,
                                                         const std::vector<std::string>& overrides);
} // namespace io
