#include "io/run_record.h"

#include "core/error.h"
#include "io/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace io
{
namespace
{
using Json = nlohmann::ordered_json;

Json to_json(Real value)
{
    return std::isfinite(value) ? Json(value) : Json();
}

Json to_json(const std::vector<Measure>& measures)
{
    Json object = Json::object();
    for (const Measure& measure : measures)
        object[measure.name] = std::holds_alternative<Real>(measure.value) ? to_json(std::get<Real>(measure.value))
                                                                           : Json(std::get<std::string>(measure.value));
    return object;
}

Json to_json(const std::vector<solver::Reference>& references)
{
    Json array = Json::array();
    for (const solver::Reference& reference : references) {
        Json object{{"name", reference.name}, {"measures", Json::object()}, {"crack_path", reference.crack_path}};
        for (const auto& [name, value] : reference.measure) object["measures"][name] = to_json(value);
        array.push_back(std::move(object));
    }
    return array;
}

/// One member of all targets by name.
template <class Member>
Json to_json(const std::vector<Target>& targets, const Member& member)
{
    Json object = Json::object();
    for (const Target& target : targets)
        if (const std::optional<Real> value = member(target)) object[target.name] = to_json(*value);
    return object;
}

std::vector<Target> read_targets(const Json& json)
{
    const auto number = [](const Json& value) {
        return value.is_null() ? std::numeric_limits<Real>::quiet_NaN() : value.get<Real>();
    };
    std::vector<Target> targets;
    if (!json.contains("errors")) return targets; // records of earlier versions
    for (const auto& [name, error] : json.at("errors").items()) {
        Target& target = targets.emplace_back(Target{name, number(json.at("targets").at(name)), number(error), {}});
        if (json.at("tolerances").contains(name)) target.tolerance = json.at("tolerances").at(name).get<Real>();
    }
    return targets;
}

std::vector<Measure> read_measures(const Json& object)
{
    std::vector<Measure> measures;
    for (const auto& [name, value] : object.items()) {
        if (value.is_string())
            measures.push_back({name, value.get<std::string>()});
        else
            measures.push_back({name, value.is_null() ? std::numeric_limits<Real>::quiet_NaN() : value.get<Real>()});
    }
    return measures;
}

std::vector<solver::Reference> read_references(const Json& array)
{
    std::vector<solver::Reference> references;
    for (const Json& object : array) {
        solver::Reference& reference = references.emplace_back();
        reference.name = object.at("name");
        reference.crack_path = object.at("crack_path");
        for (const auto& [name, value] : object.at("measures").items())
            if (value.is_number()) reference.measure[name] = value;
    }
    return references;
}

Json to_json(const RunRecord& record)
{
    const Real speed = record.wall_s > 0 ? static_cast<Real>(record.particle_steps) / record.wall_s : 0;
    return {{"title", record.title},
            {"version", record.version},
            {"commit", record.commit},
            {"status", record.status},
            {"exit_reason", record.exit_reason},
            {"compiler", record.compiler},
            {"instruction_set", record.instruction_set},
            {"threads", record.threads},
            {"wall_s", record.wall_s},
            {"cpu_s", record.cpu_s},
            {"steps", record.steps},
            {"particle_steps", record.particle_steps},
            {"particle_steps_per_s", speed},
            {"peak_rss_bytes", record.peak_rss_bytes},
            {"particles", {{"start", record.particles_start}, {"end", record.particles_end}}},
            {"modelled", record.modelled},
            {"measures", to_json(record.measures)},
            {"errors", to_json(record.targets, [](const Target& t) { return std::optional(t.error); })},
            {"targets", to_json(record.targets, [](const Target& t) { return std::optional(t.reference); })},
            {"tolerances", to_json(record.targets, [](const Target& t) { return t.tolerance; })},
            {"references", to_json(record.references)}};
}
} // namespace

void write_run_record(const std::filesystem::path& path, const RunRecord& record)
{
    constexpr int indent = 2;
    write_file(path, to_json(record).dump(indent, ' ', false, Json::error_handler_t::replace) + "\n");
}

RunRecord read_run_record(const std::filesystem::path& path)
{
    try {
        const Json json = Json::parse(read_file(path));
        RunRecord record;
        json.at("title").get_to(record.title);
        json.at("version").get_to(record.version);
        record.commit = json.value("commit", ""); // none in records of earlier versions
        json.at("status").get_to(record.status);
        json.at("exit_reason").get_to(record.exit_reason);
        json.at("compiler").get_to(record.compiler);
        json.at("instruction_set").get_to(record.instruction_set);
        json.at("threads").get_to(record.threads);
        json.at("wall_s").get_to(record.wall_s);
        // Records of earlier versions have none: as if every thread had worked all the time.
        record.cpu_s = json.value("cpu_s", record.wall_s * record.threads);
        json.at("steps").get_to(record.steps);
        json.at("particle_steps").get_to(record.particle_steps);
        json.at("peak_rss_bytes").get_to(record.peak_rss_bytes);
        json.at("particles").at("start").get_to(record.particles_start);
        json.at("particles").at("end").get_to(record.particles_end);
        json.at("modelled").get_to(record.modelled);
        record.measures = read_measures(json.at("measures"));
        record.targets = read_targets(json);
        record.references = read_references(json.at("references"));
        return record;
    } catch (const Json::exception& error) {
        throw core::FileError("cannot read '" + path.string() + "': " + error.what());
    }
}

std::string measures_line(const RunRecord& record)
{
    Json line{{"title", record.title}, {"status", record.status}};
    line.update(to_json(record.measures));
    if (!record.targets.empty())
        line["errors"] = to_json(record.targets, [](const Target& t) { return std::optional(t.error); });
    return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}
} // namespace io
