#include "io/keys.h"

#include "core/contract.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
using enum Range;

std::string_view range_text(Range range)
{
    switch (range) {
    case positive:
        return " > 0";
    case non_negative:
        return " >= 0";
    case share:
        return " in [0, 1]";
    case poisson:
        return " above -1 and below 0.5";
    case positive_or_inf:
        return " > 0 or inf";
    case any_or_inf:
        return " or +-inf";
    case finite:
        break;
    }
    return "";
}

std::vector<std::string> sections_of(std::span<const Key> keys)
{
    std::vector<std::string> names;
    for (const Key& key : keys)
        if (std::find(names.begin(), names.end(), key.section) == names.end()) names.emplace_back(key.section);
    return names;
}
} // namespace

std::vector<const Key*> keys_of(std::string_view section)
{
    std::vector<const Key*> found;
    for (const std::span<const Key> keys : {all_keys(), study_keys()})
        for (const Key& key : keys)
            if (key.section == section) found.push_back(&key);
    return found;
}

const Key& key_of(std::string_view section, std::string_view name)
{
    const std::vector<const Key*> keys = keys_of(section);
    const auto key = std::find_if(keys.begin(), keys.end(), [&](const Key* k) { return k->name == name; });
    CLEAVE_EXPECTS(key != keys.end());
    return **key;
}

std::vector<std::string> section_names()
{
    return sections_of(all_keys());
}

std::vector<std::string> study_section_names()
{
    return sections_of(study_keys());
}

std::vector<std::string> choices_of(const Key& key)
{
    std::vector<std::string> names;
    std::string_view rest = key.choices;
    while (!rest.empty()) {
        const std::size_t bar = std::min(rest.find('|'), rest.size());
        names.emplace_back(rest.substr(0, bar));
        rest.remove_prefix(std::min(bar + 1, rest.size()));
    }
    return names;
}

std::string expected(const Key& key)
{
    const std::string unit = key.dimension == dimension::none ? "" : fmt::format(" [{}]", unit_name(key.dimension));
    switch (key.type) {
    case Type::boolean:
        return "true or false";
    case Type::integer:
        return fmt::format("whole number{}", range_text(key.range));
    case Type::real:
        return fmt::format("{}{}{}", quantity_name(key.dimension), range_text(key.range), unit);
    case Type::wall_time:
        return "wall time > 0 [s], such as \"20 min\"";
    case Type::text:
        return "text in quotes";
    case Type::choice: {
        std::vector<std::string> choices = choices_of(key);
        for (std::string& name : choices) name = "\"" + name + "\"";
        return fmt::format("{}", fmt::join(choices, " or "));
    }
    case Type::axis:
        return "\"x\", \"y\" or \"z\"";
    case Type::vector:
        return fmt::format("three numbers [x, y, z]{}", unit);
    case Type::velocity:
        return fmt::format("velocity or [x, y, z] of velocities and \"free\"{}", unit);
    case Type::names:
        return "list of texts";
    case Type::values:
        return "list of values";
    case Type::points:
        return fmt::format("list of points [[x, y, z], ...]{}", unit);
    case Type::corners:
        return fmt::format("list of at least 3 pairs [[x, y], ...]{}", unit);
    case Type::shape:
        return "shape such as { sphere = { centre = [0, 0, 0], radius = 1 } }";
    case Type::shapes:
        return "list of shapes";
    case Type::table:
        return "table";
    }
    return "";
}
} // namespace io
