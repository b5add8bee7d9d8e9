#include "io/sweep.h"

#include "core/error.h"
#include "io/case.h"
#include "io/study_sections.h"
#include "solver/measures.h"

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

/// An override, to be looked at before the runs: what is wrong with its key is wrong in all of them.
struct WrittenOverride
{
    std::string text;
    Place place;
};

/// Those of the key "set" of a section that are overrides at all.
std::vector<WrittenOverride> written_overrides(SectionReader& section)
{
    std::vector<WrittenOverride> written;
    const Node* list = section.find("set");
    if (!list) return written;
    for (const Node& item : list->items)
        if (const std::size_t equals = item.text.find('='); equals != std::string::npos && equals > 0)
            written.push_back({item.text, item.place});
    return written;
}

/// Complain about overrides whose keys the case does not know: once each and here, not once in every run.
/// @param of_case  empty: there is none to ask
/// @param already  how many of them had that before
/// @return how many had a complaint now
std::size_t check_keys(Diagnostics& diagnostics, const std::filesystem::path& of_case,
                       const std::vector<WrittenOverride>& written, std::size_t already)
{
    if (of_case.empty()) return 0;
    std::vector<std::string> overrides;
    for (const WrittenOverride& one : written) overrides.push_back(one.text);
    const std::vector<std::optional<Complaint>> found = complaints_of_keys(of_case, overrides);
    std::size_t count = 0;
    for (std::size_t i = already; i < found.size(); ++i) {
        if (!found[i]) continue;
        ++count;
        diagnostics.error(written[i].place, found[i]->message, found[i]->beside, found[i]->notes);
    }
    return count;
}

Axis read_vary(Diagnostics& diagnostics, const Node& item, std::vector<WrittenOverride>& written)
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
    if (!axis.name.empty() && !axis.settings.empty())
        written.push_back({axis.settings.front().set.front(), section.place("key")});
    section.finish();
    return axis;
}

void add(Setting& begun, const Axis&, const Setting& more)
{
    begun.label += (begun.label.empty() ? "" : " ") + more.label;
    begun.set.insert(begun.set.end(), more.set.begin(), more.set.end());
}

/// Every combination of [[vary]], or the runs of [[run]].
/// @param shared  overrides of all
std::vector<Setting> read_runs(Diagnostics& diagnostics, const Node& root, const std::filesystem::path& of_case,
                               const std::vector<WrittenOverride>& shared)
{
    std::vector<Axis> axes;
    std::vector<WrittenOverride> varied = shared;
    for_each_table(diagnostics, root.find("vary"), "vary",
                   [&](const Node& item) { axes.push_back(read_vary(diagnostics, item, varied)); });
    check_keys(diagnostics, of_case, varied, shared.size());
    std::vector<Setting> listed;
    std::vector<std::string> seen;
    for_each_table(diagnostics, root.find("run"), "run", [&](const Node& item) {
        SectionReader section(diagnostics, &item, "sweep.run", "run", item.place);
        listed.push_back({section.text("label"), read_overrides(diagnostics, section, "set")});
        check_unique(diagnostics, section.place("label"), "run", listed.back().label, seen);
        std::vector<WrittenOverride> all = shared;
        for (const WrittenOverride& own : written_overrides(section)) all.push_back(own);
        check_keys(diagnostics, of_case, all, shared.size());
        section.finish();
    });
    if (axes.empty() == listed.empty())
        diagnostics.error(root.place,
                          axes.empty() ? "the sweep has no runs" : "a sweep has [[vary]] or [[run]], not both",
                          "[[vary]] for every combination, [[run]] for listed ones");
    return axes.empty() ? listed : combinations<Setting>(axes, add);
}

struct WrittenTarget
{
    std::string measure;
    std::optional<Real> value;
    Real weight;
    Place place, of_measure;
};

std::vector<WrittenTarget> read_targets(Diagnostics& diagnostics, const Node* list)
{
    std::vector<WrittenTarget> targets;
    for_each_table(diagnostics, list, "target", [&](const Node& item) {
        SectionReader section(diagnostics, &item, "sweep.target", "target", item.place);
        targets.push_back({section.text("measure"), section.optional_real("value"), section.real("weight"), item.place,
                           section.place("measure")});
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

/// Complain about targets that no run of the case measures, and leave them out.
void drop_unknown(Diagnostics& diagnostics, const solver::Problem& problem, std::vector<WrittenTarget>& targets)
{
    const std::vector<std::string> names = solver::measure_names(problem);
    std::erase_if(targets, [&](const WrittenTarget& target) {
        if (std::find(names.begin(), names.end(), target.measure) != names.end()) return false;
        if (!target.measure.empty())
            diagnostics.error(target.of_measure, fmt::format("the runs have no measure '{}'", target.measure),
                              nearest_hint(target.measure, names), {fmt::format("measures: {}", joined(names))});
        return true;
    });
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
    sweep.threads = section.integer("threads");
    sweep.limit = section.optional_real("limit");
    const bool case_known = section.has("case") && std::filesystem::is_regular_file(sweep.file);
    const std::filesystem::path of_case = case_known ? sweep.file : std::filesystem::path();
    const std::vector<WrittenOverride> shared = written_overrides(section);
    const bool set_known = check_keys(diagnostics, of_case, shared, 0) == 0;
    sweep.runs = read_runs(diagnostics, root, of_case, shared);
    std::vector<WrittenTarget> targets = read_targets(diagnostics, root.find("target"));
    if (case_known && set_known) { // the case complains for itself
        const solver::Problem problem = read_case(sweep.file, sweep.set);
        drop_unknown(diagnostics, problem, targets);
        sweep.targets = merged(diagnostics, targets, find_reference(diagnostics, section, problem.references));
    }
    section.finish();
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    return sweep;
}
} // namespace io
