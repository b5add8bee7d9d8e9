/// Files of the source tree that the program uses where it finds them: scripts, measured tables.
#pragma once

#include <filesystem>
#include <optional>

namespace app
{
/// A file below the checkout that this program was built in; nothing if it was moved away from it.
std::optional<std::filesystem::path> source_file(const std::filesystem::path& relative);
} // namespace app
