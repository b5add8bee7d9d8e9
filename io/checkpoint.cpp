#include "io/checkpoint.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/checkpoint_state.h"
#include "io/hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

namespace io
{
namespace
{
constexpr std::int64_t layout_version = 1; // raise it when groups or datasets of the file change their meaning
constexpr const char* latest_name = "latest";

/// Step in the name ck_NNNNNN.h5, or -1.
std::int64_t step_of(const std::filesystem::path& path)
{
    const std::string name = path.filename().string();
    std::int64_t step = -1;
    if (name.starts_with("ck_") && name.ends_with(".h5")) {
        const char* const end = name.data() + name.size() - 3;
        if (std::from_chars(name.data() + 3, end, step).ptr != end) return -1;
    }
    return step;
}

std::vector<std::filesystem::path> newest_first(const std::filesystem::path& directory)
{
    std::vector<std::filesystem::path> paths;
    std::error_code error; // a missing directory holds no checkpoint
    for (const auto& entry : std::filesystem::directory_iterator(directory, error))
        if (step_of(entry.path()) >= 0) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return step_of(a) > step_of(b); });
    return paths;
}

/// Step of the checkpoint that `latest` names; the largest there is if it cannot be read.
std::int64_t latest_step(const std::filesystem::path& directory)
{
    try {
        std::string name = read_file(directory / latest_name);
        while (!name.empty() && name.back() == '\n') name.pop_back();
        if (const std::int64_t step = step_of(name); step >= 0) return step;
    } catch (const core::FileError&) { // killed before the first `latest` was written
    }
    return std::numeric_limits<std::int64_t>::max();
}

std::string_view next_line(std::string_view& text)
{
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

/// A resolved case less the sections that say when to stop and when to keep a state: they change no step.
std::string without_free_sections(std::string_view text)
{
    std::string rest;
    bool is_free = false;
    while (!text.empty()) {
        const std::string_view line = next_line(text);
        if (line.starts_with('[')) is_free = line == "[end]" || line == "[output.checkpoint]";
        if (!is_free) rest.append(line).push_back('\n');
    }
    return rest;
}

/// The first line in which two case texts differ, as a sentence.
std::string first_difference(std::string_view there, std::string_view here)
{
    while (!there.empty() || !here.empty()) {
        const std::string_view line_there = next_line(there), line_here = next_line(here);
        if (line_there != line_here)
            return fmt::format("the first difference is '{}' there and '{}' here", line_there, line_here);
    }
    return "the texts differ in their ends only";
}

void require_same_case(const Hdf5Reader& file, const CheckpointCase& of_case)
{
    const std::int64_t layout = file.attribute<std::int64_t>("/", "layout").at(0);
    if (layout != layout_version)
        throw core::InputError(fmt::format("cannot resume from '{}': it has layout {} (written by version {}), this "
                                           "program ({}) reads layout {}",
                                           file.path().string(), layout, file.text_attribute("/", "version"),
                                           of_case.version, layout_version));
    const auto bytes = file.dataset<std::uint8_t>("/case");
    const std::string there = without_free_sections(std::string(bytes.begin(), bytes.end()));
    const std::string here = without_free_sections(of_case.resolved);
    if (there == here) return;
    throw core::InputError(fmt::format("cannot resume from '{}': it belongs to another case; {}", file.path().string(),
                                       first_difference(there, here)));
}

/// Keep the newest `keep` up to `step`. Later ones are left-overs: damaged, or of an earlier run in this directory.
void remove_old(const std::filesystem::path& directory, std::int64_t step, int keep)
{
    std::error_code ignored; // an old checkpoint that stays does no harm
    int newer = 0;
    for (const std::filesystem::path& path : newest_first(directory)) {
        const bool left_over = step_of(path) > step;
        if (left_over || newer >= std::max(keep, 1))
            std::filesystem::remove(path, ignored);
        else
            ++newer;
    }
}
} // namespace

std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const solver::State& state,
                                       const CheckpointCase& of_case, int keep)
{
    make_directory(directory);
    const std::filesystem::path path = directory / fmt::format("ck_{:06}.h5", state.clock.step);
    Hdf5Writer file(path);
    file.attribute("/", "layout", layout_version);
    file.attribute("/", "version", std::string_view(of_case.version));
    file.dataset<std::uint8_t>("/case", std::vector<std::uint8_t>(of_case.resolved.begin(), of_case.resolved.end()));
    store_state(state, file);
    file.commit();
    write_file(directory / latest_name, path.filename().string() + "\n");
    remove_old(directory, state.clock.step, keep);
    return path;
}

solver::State read_checkpoint(const std::filesystem::path& path, const CheckpointCase& of_case)
{
    const Hdf5Reader file(path);
    require_same_case(file, of_case);
    return load_state(file);
}

std::optional<solver::State> resume(const std::filesystem::path& directory, const CheckpointCase& of_case,
                                    const std::function<void(const std::string&)>& warn)
{
    std::vector<std::filesystem::path> candidates = newest_first(directory);
    std::erase_if(candidates, [latest = latest_step(directory)](const auto& path) { return step_of(path) > latest; });
    std::string last_error;
    for (const std::filesystem::path& path : candidates) {
        try {
            return read_checkpoint(path, of_case);
        } catch (const core::FileError& error) {
            last_error = error.what();
            warn("skipped a damaged checkpoint: " + last_error);
        }
    }
    if (!candidates.empty()) throw core::FileError("no checkpoint can be read; the oldest: " + last_error);
    return {};
}
} // namespace io
