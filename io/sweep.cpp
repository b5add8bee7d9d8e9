#include "io/sweep.h"

#include "core/error.h"
#include "io/case.h"
#include "io/study_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace io
{
namespace
{
/// "s_max" of "material.steel.decohesion.s_max": short labels, as long as they say which key is meant.
std::string short_key(const std::string& key)
{
    return key.substr(key.rfind('.') + 1);
}

std::string label_text(const Node& value)
{
    return value.kind == Node::Kind::text ? value.text : write_value(value);
}

Axis read_vary(Diagnostics& diagnostics, const Node& item)
{
    SectionReader section(diagnostics, &item, "sweep.vary", "vary", item.place);
    Axis axis;
    axis.name = section.text("key");
    const Node* values = section.find("values");
    if (!values)
        section.error("values", fmt::format("no values for '{}'", axis.name), "expected values = [...]");
    else if (values->kind != Node::Kind::list || values->items.empty())
        type_error(*values, key_of("sweep.vary", "values"), diagnostics);
    else
        for (const Node& value : values->items)
            axis.settings.push_back({fmt::format("{}={}", short_key(axis.name), label_text(value)),
                                     {fmt::format("{}={}", axis.name, write_value(value))}});
    section.finish();
    return axis;
}

/// Every combination of one setting of each axis, the last axis fastest.
std::vector<Setting> combinations(const std::vector<Axis>& axes)
{
    std::vector<Setting> all{{}};
    for (const Axis& axis : axes) {
        std::vector<Setting> longer;
        for (const Setting& begun : all)
            for (const Setting& setting : axis.settings) {
                Setting& both = longer.emplace_back(begun);
                both.label += (both.label.empty() ? "" : " ") + setting.label;
                both.set.insert(both.set.end(), setting.set.begin(), setting.set.end());
            }
        all = std::move(longer);
    }
    return all;
}

struct WrittenTarget
{
    std::string measure;
    std::optional<Real> value;
    Real weight;
    Place place;
};

std::vector<WrittenTarget> read_targets(Diagnostics& diagnostics, const Node* list)
{
    std::vector<WrittenTarget> targets;
    for_each_table(diagnostics, list, "target", [&](const Node& item) {
        SectionReader section(diagnostics, &item, "sweep.target", "target", item.place);
        targets.push_back(
            {section.text("measure"), section.optional_real("value"), section.real("weight"), item.place});
        if (targets.back().value && *targets.back().value == 0)
            section.error("value", "a distance relative to 0 has no meaning");
        section.finish();
    });
    return targets;
}

const solver::Reference* find_reference(Diagnostics& diagnostics, SectionReader& section,
                                        const std::vector<solver::Reference>& references)
{
    const std::optional<std::string> name = section.optional_text("reference");
    if (!name) return nullptr;
    std::vector<std::string> names;
    for (const solver::Reference& reference : references) {
        if (reference.name == *name) return &reference;
        names.push_back(reference.name);
    }
    diagnostics.error(section.place("reference"), fmt::format("the case has no reference '{}'", *name),
                      nearest_hint(*name, names), {fmt::format("references there: {}", joined(names))});
    return nullptr;
}

/// The measures of the reference with weight 1, but as [[target]] says where there is one.
std::vector<SweepTarget> merged(Diagnostics& diagnostics, const std::vector<WrittenTarget>& written,
                                const solver::Reference* reference)
{
    std::vector<SweepTarget> targets;
    if (reference)
        for (const auto& [measure, value] : reference->measure)
            if (std::isfinite(value) && value != 0) targets.push_back({measure, value, 1});
    for (const WrittenTarget& one : written) {
        auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const SweepTarget& t) { return t.measure == one.measure; });
        if (found == targets.end() && !one.value)
            diagnostics.error(one.place, fmt::format("target '{}' has no value", one.measure),
                              reference ? "the reference has none either" : "add value, or name a reference");
        else if (found == targets.end())
            targets.push_back({one.measure, *one.value, one.weight});
        else
            *found = {one.measure, one.value.value_or(found->value), one.weight};
    }
    return targets;
}
} // namespace

Sweep read_sweep(const std::filesystem::path& file)
{
    Diagnostics diagnostics;
    const Node root = load_document(file, {}, diagnostics);
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    SectionReader section(diagnostics, &root, "sweep", "", root.place);
    Sweep sweep;
    sweep.title = section.text("title");
    sweep.file = case_beside(section, file);
    sweep.set = read_overrides(diagnostics, section, "set");
    sweep.threads = static_cast<int>(section.integer("threads"));
    sweep.limit = section.optional_real("limit");
    std::vector<Axis> axes;
    for_each_table(diagnostics, root.find("vary"), "vary",
                   [&](const Node& item) { axes.push_back(read_vary(diagnostics, item)); });
    std::vector<std::string> seen;
    for_each_table(diagnostics, root.find("run"), "run", [&](const Node& item) {
        SectionReader inner(diagnostics, &item, "sweep.run", "run", item.place);
        sweep.runs.push_back({inner.text("label"), read_overrides(diagnostics, inner, "set")});
        check_unique(diagnostics, inner.place("label"), "run", sweep.runs.back().label, seen);
        inner.finish();
    });
    if (axes.empty() == sweep.runs.empty())
        diagnostics.error(root.place,
                          axes.empty() ? "the sweep has no runs" : "a sweep has [[vary]] or [[run]], not both",
                          "[[vary]] for every combination, [[run]] for listed ones");
    if (!axes.empty()) sweep.runs = combinations(axes);
    const std::vector<WrittenTarget> written = read_targets(diagnostics, root.find("target"));
    // The case complains for itself, once this file is in order.
    const bool case_known = section.has("case") && std::filesystem::is_regular_file(sweep.file);
    std::vector<solver::Reference> references;
    if (case_known) references = read_case(sweep.file, sweep.set).references;
    sweep.targets = merged(diagnostics, written, find_reference(diagnostics, section, references));
    section.finish();
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    return sweep;
}
} // namespace io
