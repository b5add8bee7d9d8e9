/// Reading cases of a single material point for `cleave point`: [material.NAME] as in any case, and [point].
#pragma once

#include "solver/point_path.h"

#include <filesystem>
#include <string>
#include <vector>

namespace io
{
struct PointCase
{
    std::string title;
    solver::PointPath path;
    std::string resolved; // case file with every default written out
};

/// @param overrides  as in io/case.h
/// @error core::InputError with the text of every error; core::FileError if `file` cannot be read
PointCase read_point_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
} // namespace io
