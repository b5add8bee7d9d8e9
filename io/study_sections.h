/// What the files of `cleave chart` and `cleave sweep` have in common.
#pragma once

#include "io/section_reader.h"

#include <filesystem>
#include <functional>

namespace io
{
/// Visit the tables of the array [[name]] in order; an error if it is something else, or empty.
void for_each_table(Diagnostics& diagnostics, const Node* list, const std::string& name,
                    const std::function<void(const Node& item)>& visit);

/// The case file a section names, relative to the file it stands in; an error if there is none.
std::filesystem::path case_beside(SectionReader& section, const std::filesystem::path& file);

/// Overrides "key=value"; an error for one without a key.
std::vector<std::string> read_overrides(Diagnostics& diagnostics, SectionReader& section, std::string_view key);

/// An error if a name was used before.
void check_unique(Diagnostics& diagnostics, const Place& place, const std::string& kind, const std::string& name,
                  std::vector<std::string>& seen);
} // namespace io
