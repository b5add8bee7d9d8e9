#include "io/case_draft.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
void check_load_name(Draft& draft, const std::string& name, const Place& place)
{
    std::vector<std::string> names;
    for (const solver::Load& load : draft.problem.loads) names.push_back(load.name);
    for (const solver::SurfaceLoad& load : draft.problem.surface_loads) names.push_back(load.name);
    if (std::find(names.begin(), names.end(), name) == names.end()) unknown_name(draft, place, "load", name, names);
}

/// Width of a corridor nobody gave: a crack between two round holes stays between their common tangents, so twice the
/// smaller in-radius; a feature whose centre lies on its edge (a plate's face) has none. Never under 4 finest cells.
Real default_width(const solver::Grid& grid, const solver::Feature& from, const solver::Feature& to)
{
    const Real least = 4 * grid.cell / static_cast<Real>(1 << (grid.levels - 1));
    Real width = 0;
    for (const solver::Feature* feature : {&from, &to}) {
        const Real in_radius = -feature->shape.distance(feature->centre);
        if (in_radius > 0) width = width > 0 ? std::min(width, 2 * in_radius) : 2 * in_radius;
    }
    return std::max(width, least);
}

/// Rectangle around the segment between two centres, in the plane across `through`.
std::vector<Pair> rectangle(const Vec3& from, const Vec3& to, int through, Real width)
{
    const int a = (through + 1) % 3, b = (through + 2) % 3;
    const Eigen::Vector2d start(from[a], from[b]), end(to[a], to[b]);
    const Eigen::Vector2d along = (end - start).normalized();
    const Eigen::Vector2d side = width / 2 * Eigen::Vector2d(-along[1], along[0]);
    std::vector<Pair> corners;
    for (const Eigen::Vector2d& corner : {Eigen::Vector2d(start - side), Eigen::Vector2d(end - side),
                                          Eigen::Vector2d(end + side), Eigen::Vector2d(start + side)})
        corners.push_back({corner[0], corner[1]});
    return corners;
}

void read_ligament(Draft& draft, const Node& item)
{
    SectionReader section(draft.diagnostics, &item, "ligament", "ligament", item.place);
    solver::Ligament ligament;
    ligament.from = section.text("from");
    ligament.to = section.text("to");
    ligament.through = section.axis("through");
    const std::optional<Real> width = section.optional_real("width");
    if (section.has("corridor")) {
        ligament.corridor = section.corners("corridor");
        if (width) section.error("width", "a ligament has either a width or a corridor");
    }
    const solver::Feature* from = section.sound() ? find_feature(draft, ligament.from, section.place("from")) : nullptr;
    const solver::Feature* to = section.sound() ? find_feature(draft, ligament.to, section.place("to")) : nullptr;
    if (from && to && from == to) section.error("to", "a ligament joins two different features");
    for (const solver::Ligament& other : draft.problem.ligaments)
        if (from && to && from != to && std::minmax(other.from, other.to) == std::minmax(ligament.from, ligament.to))
            section.error("from", fmt::format("there are two ligaments of '{}' and '{}'", ligament.from, ligament.to));
    if (from && to && from != to && draft.grid.sound && ligament.corridor.empty()) {
        const Real used = width ? *width : default_width(draft.problem.grid, *from, *to);
        ligament.corridor = rectangle(from->centre, to->centre, ligament.through, used);
        section.record("width", node(used));
    }
    section.finish();
    draft.problem.ligaments.push_back(std::move(ligament));
    keep_item(draft, {"ligament"}, section.resolved());
}

void read_reference(Draft& draft, const Node& item)
{
    SectionReader section(draft.diagnostics, &item, "reference", "reference", item.place);
    solver::Reference reference;
    reference.name = section.text("name");
    for (const Key* key : keys_of("reference"))
        if (key->type == Type::real)
            if (const std::optional<Real> value = section.optional_real(key->name))
                reference.measure[std::string(key->name)] = *value;
    reference.crack_path = section.text("crack_path");
    section.finish();
    draft.problem.references.push_back(std::move(reference));
    keep_item(draft, {"reference"}, section.resolved());
}
} // namespace

void read_gauge(Draft& draft)
{
    const Node* gauges = draft.root.find("gauge");
    if (!gauges) return;
    SectionReader(draft.diagnostics, gauges, "gauge", "gauge", gauges->place).finish();
    const Node* table = gauges->find("cod");
    if (!table) return;
    SectionReader section(draft.diagnostics, table, "gauge.cod", "gauge.cod", table->place);
    solver::Gauge gauge;
    gauge.upper = section.vector("upper");
    gauge.lower = section.vector("lower");
    gauge.axis = section.axis("axis");
    section.finish();
    draft.problem.gauge = gauge;
    draft.gauge = {section.place(), section.sound()};
    keep(draft, {"gauge", "cod"}, section.resolved());
}

void read_forces(Draft& draft)
{
    const Node* table = draft.root.find("forces");
    if (!table) return;
    SectionReader section(draft.diagnostics, table, "forces", "forces", table->place);
    draft.problem.force_upper = section.text("upper");
    draft.problem.force_lower = section.text("lower");
    draft.problem.force_axis = section.axis("axis");
    for (const std::string_view side : {"upper", "lower"})
        if (section.has(side) && section.sound()) check_load_name(draft, section.find(side)->text, section.place(side));
    if (section.sound() && section.has("upper") && draft.problem.force_upper == draft.problem.force_lower)
        section.error("lower", fmt::format("'upper' and 'lower' are the same load '{}'", draft.problem.force_lower),
                      "leave one of them out: the other is the force then");
    if (!section.has("upper") && !section.has("lower"))
        section.error("upper", "[forces] names no load", "add upper or lower = a load's name");
    section.finish();
    keep(draft, {"forces"}, section.resolved());
}

void read_ligaments(Draft& draft)
{
    for_each_item(draft, draft.root.find("ligament"), "ligament",
                  [&](const Node& item) { read_ligament(draft, item); });
}

void read_crack(Draft& draft)
{
    const Node* table = draft.root.find("crack");
    if (!table) return;
    SectionReader section(draft.diagnostics, table, "crack", "crack", table->place);
    draft.problem.start_features = section.distinct_names("start");
    for (std::size_t i = 0; section.sound() && i < draft.problem.start_features.size(); ++i)
        (void)find_feature(draft, draft.problem.start_features[i], section.find("start")->items[i].place);
    draft.problem.mean_over = section.real("mean_over");
    section.finish();
    keep(draft, {"crack"}, section.resolved());
}

void read_references(Draft& draft)
{
    for_each_item(draft, draft.root.find("reference"), "reference",
                  [&](const Node& item) { read_reference(draft, item); });
}
} // namespace io
