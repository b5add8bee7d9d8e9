#include "io/checkpoint.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/checkpoint_state.h"
#include "io/hdf5.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

namespace io
{
namespace
{
constexpr std::int64_t layout_version = 2; // raise it when groups or datasets of the file change their meaning

/// Step of the checkpoint that `latest` names; the largest there is if it cannot be read.
std::int64_t latest_step(const std::filesystem::path& directory)
{
    try {
        std::string name = read_file(directory / checkpoint_files.list);
        while (!name.empty() && name.back() == '\n') name.pop_back();
        if (const std::int64_t step = checkpoint_files.number(name); step >= 0) return step;
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

void require_same_layout(const Hdf5Reader& file, const CheckpointCase& of_case)
{
    const std::int64_t layout = file.attribute<std::int64_t>("/", "layout").at(0);
    if (layout != layout_version)
        throw core::InputError(fmt::format("cannot resume from '{}': it has layout {} (written by version {}), this "
                                           "program ({}) reads layout {}",
                                           file.path().string(), layout, file.text_attribute("/", "version"),
                                           of_case.version, layout_version));
}

/// Keep the newest `keep` up to `step`. Later ones are left-overs: damaged, or of an earlier run in this directory.
void remove_old(const std::filesystem::path& directory, std::int64_t step, int keep)
{
    std::error_code ignored; // an old checkpoint that stays does no harm
    int newer = 0;
    for (const std::filesystem::path& path : newest_first(directory, checkpoint_files)) {
        const bool left_over = checkpoint_files.number(path) > step;
        if (left_over || newer >= std::max(keep, 1))
            std::filesystem::remove(path, ignored);
        else
            ++newer;
    }
    remove_temporaries(directory, checkpoint_files);
}
} // namespace

void require_same_case(const std::filesystem::path& source, std::string_view there, const CheckpointCase& of_case)
{
    const std::string other = without_free_sections(there), own = without_free_sections(of_case.resolved);
    if (other == own) return;
    throw core::InputError(fmt::format("cannot resume from '{}': it belongs to another case; {}", source.string(),
                                       first_difference(other, own)));
}

std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const solver::State& state,
                                       const CheckpointCase& of_case, int keep)
{
    make_directory(directory);
    const std::filesystem::path path = directory / checkpoint_files.name(state.clock.step);
    Hdf5Writer file(path);
    file.attribute("/", "layout", layout_version);
    file.attribute("/", "version", std::string_view(of_case.version));
    file.dataset<std::uint8_t>("/case", std::vector<std::uint8_t>(of_case.resolved.begin(), of_case.resolved.end()));
    store_state(state, file);
    file.commit();
    write_file(directory / checkpoint_files.list, path.filename().string() + "\n");
    remove_old(directory, state.clock.step, keep);
    return path;
}

solver::State read_checkpoint(const std::filesystem::path& path, const CheckpointCase& of_case)
{
    const Hdf5Reader file(path);
    require_same_layout(file, of_case);
    const auto bytes = file.dataset<std::uint8_t>("/case");
    require_same_case(path, std::string(bytes.begin(), bytes.end()), of_case);
    return load_state(file);
}

std::optional<solver::State> resume(const std::filesystem::path& directory, const CheckpointCase& of_case,
                                    const std::function<void(const std::string&)>& warn)
{
    std::vector<std::filesystem::path> candidates = newest_first(directory, checkpoint_files);
    std::erase_if(candidates, [latest = latest_step(directory)](const auto& path) {
        return checkpoint_files.number(path) > latest;
    });
    std::string last_error;
    for (const std::filesystem::path& path : candidates) {
        try {
            return read_checkpoint(path, of_case);
        } catch (const core::FileError& error) {
            last_error = error.what();
            warn("skipped a damaged checkpoint: " + last_error);
        }
    }
    if (!candidates.empty())
        throw core::FileError(fmt::format("no checkpoint can be read; the oldest: {}\nStart again with --force, or "
                                          "with another -o if this directory is to stay as it is.",
                                          last_error));
    return {};
}
} // namespace io
