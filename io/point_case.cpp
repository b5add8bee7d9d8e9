#include "io/point_case.h"

#include "core/error.h"
#include "io/case_draft.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
std::string read_top(Draft& draft)
{
    SectionReader section(draft.diagnostics, &draft.root, "", "", draft.root.place);
    (void)section.choice<int>("units");
    const std::string title = section.text("title");
    section.finish();
    for (const Entry& entry : section.resolved().entries) keep(draft, {entry.key}, entry.value);
    constexpr std::array<std::string_view, 5> meant{"units", "title", "include", "material", "point"};
    for (const Key* key : keys_of(""))
        if (section.has(key->name) && std::find(meant.begin(), meant.end(), key->name) == meant.end())
            section.error(key->name, fmt::format("a case with [point] has no '{}'", key->name),
                          "a material point has no grid, body or load");
    return title;
}

/// The six components of a symmetric tensor, each given or not.
std::array<std::optional<Real>, 6> read_components(Draft& draft, SectionReader& segment, std::string_view name)
{
    std::array<std::optional<Real>, 6> out;
    const Node* value = segment.find(name);
    if (!value) return out;
    const std::string schema = fmt::format("point.segment.{}", name);
    SectionReader section(draft.diagnostics, value, schema, schema, value->place);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = section.optional_real(solver::component_names[i]);
    section.finish();
    segment.record(name, section);
    return out;
}

solver::PointSegment read_segment(Draft& draft, const Node& item)
{
    SectionReader section(draft.diagnostics, &item, "point.segment", "point.segment", item.place);
    solver::PointSegment segment;
    segment.steps = section.integer("steps");
    segment.strain = read_components(draft, section, "strain");
    const auto stress = read_components(draft, section, "stress");
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const std::string_view name = solver::component_names[i];
        segment.stress[static_cast<int>(i)] = stress[i].value_or(0);
        // By presence, not by value: a value that could not be read is a conflict all the same.
        if (section.find("strain") && section.find("strain")->find(name) && section.find("stress") &&
            section.find("stress")->find(name))
            draft.diagnostics.error(section.find("stress")->find(name)->place,
                                    fmt::format("strain and stress of component '{}' are both prescribed", name),
                                    "give one of them");
    }
    const Vec3 rotation = section.vector("rotation");
    segment.rotation = {{rotation[0], rotation[1], rotation[2]}};
    section.finish();
    keep_item(draft, {"point", "segment"}, section.resolved());
    return segment;
}

solver::PointPath read_path(Draft& draft, const Node& point)
{
    SectionReader section(draft.diagnostics, &point, "point", "point", point.place);
    solver::PointPath path;
    const std::string name = section.text("material");
    if (section.sound())
        if (const material::Material* found = find_material(draft, name, section.place("material")))
            path.material = *found;
    path.spacing = section.real("cell");
    // As a run with cfl = 0.5 would step through a cell of this size.
    path.step_time = section.optional_real("step_time").value_or(0);
    if (path.step_time == 0) {
        path.step_time = 0.5 * path.spacing / path.material.elastic.wave_speed();
        section.record("step_time", node(path.step_time));
    }
    section.finish();
    keep(draft, {"point"}, section.resolved());
    for_each_item(draft, section.find("segment"), "point.segment",
                  [&](const Node& item) { path.segments.push_back(read_segment(draft, item)); });
    if (!section.has("segment"))
        draft.diagnostics.error(point.place, "the point has no path", "add a table [[point.segment]]");
    return path;
}
} // namespace

PointCase read_point_case(const std::filesystem::path& file, const std::vector<std::string>& overrides)
{
    Diagnostics diagnostics;
    const Node root = load_document(file, overrides, diagnostics);
    Draft draft(root, diagnostics);
    const Node* point = root.find("point");
    if (!point && diagnostics.error_count() == 0)
        diagnostics.error(root.place, "the case has no [point]", "`cleave run` runs cases with bodies");
    // After a syntax error, or in a case of another kind, everything else would only be noise.
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());

    PointCase out;
    out.title = read_top(draft);
    read_materials(draft);
    out.path = read_path(draft, *point);
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    out.resolved = write_document(draft.resolved);
    return out;
}
} // namespace io
