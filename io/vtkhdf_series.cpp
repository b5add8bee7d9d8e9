#include "io/vtkhdf_series.h"

#include "core/error.h"
#include "io/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace io
{
namespace
{
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries)
{
    nlohmann::ordered_json series{{"file-series-version", "1.0"}, {"files", nlohmann::ordered_json::array()}};
    for (const SeriesEntry& entry : entries) series["files"].push_back({{"name", entry.name}, {"time", entry.time}});
    write_file(path, series.dump(1) + "\n");
}
} // namespace

void write_vtkhdf_head(const solver::Clock& clock, std::string_view program_version, std::string_view type,
                       Hdf5Writer& file)
{
    file.attribute("/", "time", clock.time);
    file.attribute("/", "step", clock.step);
    file.attribute("/", "units", std::string_view("mm-g-ms"));
    file.attribute("/", "version", program_version);
    file.group("/VTKHDF");
    file.attribute<std::int64_t>("/VTKHDF", "Version", std::span(vtkhdf_version));
    file.attribute("/VTKHDF", "Type", type);
}

std::vector<SeriesEntry> read_series(const std::filesystem::path& path)
{
    std::vector<SeriesEntry> entries;
    if (!std::filesystem::exists(path)) return entries;
    try {
        const auto series = nlohmann::json::parse(read_file(path));
        for (const auto& entry : series.at("files")) entries.push_back({entry.at("name"), entry.at("time")});
    } catch (const nlohmann::json::exception& error) {
        throw core::FileError("cannot read '" + path.string() + "': " + error.what());
    }
    return entries;
}

void enter_frame(const std::filesystem::path& path, const SeriesEntry& entry)
{
    std::vector<SeriesEntry> entries = read_series(path);
    std::erase_if(entries, [&](const SeriesEntry& old) { return old.name == entry.name; });
    entries.push_back(entry);
    std::stable_sort(entries.begin(), entries.end(),
                     [](const SeriesEntry& a, const SeriesEntry& b) { return a.time < b.time; });
    write_series(path, entries);
}

void rewind_series(const std::filesystem::path& path, Real time)
{
    if (!std::filesystem::exists(path)) return;
    std::vector<SeriesEntry> entries = read_series(path);
    std::erase_if(entries, [&](const SeriesEntry& entry) { return entry.time > time; });
    write_series(path, entries);
}
} // namespace io
