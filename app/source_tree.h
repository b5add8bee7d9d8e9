/// Files of the source tree that the program uses where it finds them: scripts, measured tables.
#pragma once

#include <filesystem>
#include <optional>

namespace app
{
/// A file below the checkout that this program was built in; nothing if it was moved away from it.
std::optional<std::filesystem::path> source_file(const std::filesystem::path& relative);

/// A file named in a table of the source tree: the path itself if it is there, else that below the checkout; the path
/// again if neither is.
std::filesystem::path here_or_source(const std::filesystem::path& file);
} // namespace app
