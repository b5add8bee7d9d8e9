#include "io/job_record.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/diagnostics.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace io
{
namespace
{
using Json = nlohmann::ordered_json;
} // namespace

void write_job_record(const std::filesystem::path& path, const JobRecord& record)
{
    const Json json{
        {"version", record.version},        {"exit_code", record.exit_code}, {"over_limit", record.over_limit},
        {"limit_s", record.limit_s},        {"cpu_s", record.cpu_s},         {"wall_s", record.wall_s},
        {"peak_rss_bytes", record.peak_rss}};
    write_file(path, json.dump(2) + "\n");
}

std::optional<JobRecord> read_job_record(const std::filesystem::path& path)
{
    if (!std::filesystem::exists(path)) return std::nullopt;
    try {
        const Json json = Json::parse(read_file(path));
        JobRecord record;
        json.at("version").get_to(record.version);
        json.at("exit_code").get_to(record.exit_code);
        json.at("over_limit").get_to(record.over_limit);
        json.at("limit_s").get_to(record.limit_s);
        json.at("cpu_s").get_to(record.cpu_s);
        json.at("wall_s").get_to(record.wall_s);
        json.at("peak_rss_bytes").get_to(record.peak_rss);
        return record;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

struct RunNumbers::Tree
{
    Json root;

    const Json* find(const std::string& path) const
    {
        const Json* place = &root;
        std::size_t begin = 0;
        while (begin <= path.size()) {
            const std::size_t end = std::min(path.find('.', begin), path.size());
            const auto found = place->find(path.substr(begin, end - begin));
            if (!place->is_object() || found == place->end()) return nullptr;
            place = &*found;
            begin = end + 1;
        }
        return place;
    }
};

RunNumbers::RunNumbers(const std::filesystem::path& run_json) : tree_(std::make_unique<Tree>())
{
    try {
        tree_->root = Json::parse(read_file(run_json));
    } catch (const Json::exception& error) {
        throw core::FileError("cannot read '" + run_json.string() + "': " + error.what());
    }
}

RunNumbers::~RunNumbers() = default;
RunNumbers::RunNumbers(RunNumbers&&) noexcept = default;

std::optional<Real> RunNumbers::number(const std::string& path) const
{
    const Json* found = tree_->find(path);
    if (!found) return std::nullopt;
    if (found->is_number()) return found->get<Real>();
    if (found->is_null()) return std::numeric_limits<Real>::quiet_NaN();
    return std::nullopt;
}

Real RunNumbers::total(const std::string& path) const
{
    Real sum = 0;
    if (const Json* found = tree_->find(path); found && found->is_array())
        for (const Json& item : *found)
            if (item.is_number()) sum += item.get<Real>();
    return sum;
}

std::string RunNumbers::text(const std::string& path) const
{
    const Json* found = tree_->find(path);
    return found && found->is_string() ? found->get<std::string>() : std::string();
}

std::string RunNumbers::known() const
{
    std::vector<std::string> names;
    for (const std::string part : {"errors", "measures"})
        if (const Json* found = tree_->find(part); found && found->is_object())
            for (const auto& [name, value] : found->items())
                if (value.is_number() || value.is_null()) names.push_back(part + "." + name);
    return joined(names);
}
} // namespace io
