#include "io/case_draft.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
void read_feature(Draft& draft, const Node& table, const std::string& name_in_header, const Place& place)
{
    SectionReader section(draft.diagnostics, &table, "feature",
                          name_in_header.empty() ? "feature" : "feature." + name_in_header, place);
    solver::Feature feature;
    feature.name = name_in_header.empty() ? section.text("name") : name_in_header;
    if (feature.name.empty() && section.sound()) section.error("name", "a [[feature]] needs a name");
    if (!name_in_header.empty() && section.has("name"))
        section.error("name", fmt::format("[{}] has its name in its header", section.path()));
    for (const solver::Feature& other : draft.problem.features)
        if (other.name == feature.name) section.error("name", fmt::format("there are two features '{}'", feature.name));
    feature.centre = section.vector("centre");
    const int axis = section.axis("axis");
    const std::optional<Real> diameter = section.optional_real("diameter");
    if (section.has("shape") == section.has("diameter"))
        section.error("shape", "a feature has either a shape or the diameter of a hole");
    else if (section.has("shape"))
        feature.shape = read_shape(draft, section, "shape");
    else if (section.sound())
        feature.shape = round_hole(feature.centre, axis, *diameter / 2);
    section.finish();
    draft.features.push_back({place, section.sound()});
    Node resolved = section.resolved();
    std::erase_if(resolved.entries, [](const Entry& entry) { return entry.key == "name"; });
    keep(draft, {"feature", feature.name}, std::move(resolved));
    draft.problem.features.push_back(std::move(feature));
}

} // namespace

void read_features(Draft& draft)
{
    const Node* features = draft.root.find("feature");
    if (!features) return;
    if (features->kind == Node::Kind::table)
        for_each_named(draft, *features, "feature",
                       [&](const Entry& entry) { read_feature(draft, entry.value, entry.key, entry.place); });
    else
        for_each_item(draft, features, "feature", [&](const Node& item) { read_feature(draft, item, "", item.place); });
}

void read_bodies(Draft& draft)
{
    for_each_item(draft, draft.root.find("body"), "body", [&](const Node& item) {
        SectionReader section(draft.diagnostics, &item, "body", "body", item.place);
        solver::Body body;
        body.name = section.text("name");
        if (body.name.empty()) body.name = fmt::format("body {}", draft.problem.bodies.size());
        section.record("name", node(std::string_view(body.name)));
        for (const solver::Body& other : draft.problem.bodies)
            if (other.name == body.name) section.error("name", fmt::format("there are two bodies '{}'", body.name));
        body.shape = read_shape(draft, section, "shape");
        const std::string material = section.text("material");
        if (section.has("material") && !material.empty())
            body.material = material_index(draft, material, section.place("material"));
        body.velocity = section.vector("velocity");
        body.initial = find_motion(draft, section, "initial");
        body.body_force = find_motion(draft, section, "body_force");
        if (section.has("initial") && section.has("velocity"))
            section.error("velocity", "a body has either a velocity or an initial motion");
        section.finish();
        const geometry::Bounds bounds = body.shape.bounds();
        if (section.sound() && !(bounds.lower.allFinite() && bounds.upper.allFinite()))
            section.error("shape", fmt::format("body '{}' has no end", body.name),
                          "intersect it with a box, or give polygons lower and upper");
        draft.bodies.push_back({section.place("shape"), section.sound()});
        draft.problem.bodies.push_back(std::move(body));
        Node resolved = section.resolved();
        if (section.has("initial"))
            std::erase_if(resolved.entries, [](const Entry& entry) { return entry.key == "velocity"; });
        keep_item(draft, {"body"}, std::move(resolved));
    });
    if (!draft.root.find("body"))
        draft.diagnostics.error(draft.root.place, "the case has no body", "add a table [[body]]");
}

void read_symmetry(Draft& draft)
{
    for_each_item(draft, draft.root.find("symmetry"), "symmetry", [&](const Node& item) {
        SectionReader section(draft.diagnostics, &item, "symmetry", "symmetry", item.place);
        solver::SymmetryPlane plane;
        plane.axis = section.axis("axis");
        plane.at = section.real("at");
        section.finish();
        draft.symmetry.push_back({section.place("at"), section.sound()});
        draft.problem.symmetry.push_back(plane);
        keep_item(draft, {"symmetry"}, section.resolved());
    });
}
} // namespace io
