#include "io/numbered_files.h"

#include "io/atomic_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace io
{
std::string NumberedFiles::name(std::int64_t number) const
{
    return fmt::format("{}{:0{}}{}", begin, number, digits, end);
}

std::int64_t NumberedFiles::number(const std::filesystem::path& path) const
{
    const std::string text = path.filename().string();
    std::string_view rest = text;
    if (!rest.starts_with(begin)) return -1;
    rest.remove_prefix(std::string_view(begin).size());
    std::int64_t value = -1;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    // "ck_7.h5" is somebody's own: only the name that would be written counts.
    return error == std::errc() && value >= 0 && name(value) == text ? value : -1;
}

std::vector<std::filesystem::path> newest_first(const std::filesystem::path& folder, const NumberedFiles& kind)
{
    std::vector<std::filesystem::path> paths;
    std::error_code error; // a missing folder holds none
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (kind.number(entry.path()) >= 0) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end(),
              [&](const auto& a, const auto& b) { return kind.number(a) > kind.number(b); });
    return paths;
}

void remove_temporaries(const std::filesystem::path& folder, const NumberedFiles& kind)
{
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (const std::filesystem::path final_name = name_of_temporary(entry.path());
            !final_name.empty() && (kind.number(final_name) >= 0 || final_name == kind.list))
            found.push_back(entry.path());
    for (const std::filesystem::path& path : found) std::filesystem::remove(path, error);
}

void remove_all(const std::filesystem::path& directory, const NumberedFiles& kind)
{
    const std::filesystem::path folder = directory / kind.folder;
    if (!std::filesystem::is_directory(folder)) return;
    remove_temporaries(folder, kind);
    for (const std::filesystem::path& path : newest_first(folder, kind)) std::filesystem::remove(path);
    if (*kind.list != '\0') std::filesystem::remove(folder / kind.list);
    if (std::filesystem::is_empty(folder)) std::filesystem::remove(folder);
}
} // namespace io
