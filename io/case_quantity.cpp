#include "io/case_draft.h"
#include "solver/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace io
{
namespace
{
using solver::FieldComponent;
using Kind = decltype(solver::Quantity::kind);

geometry::Shape read_region(Draft& draft, SectionReader& section)
{
    return section.has("region") ? read_shape(draft, section, "region") : geometry::Shape();
}

FieldComponent read_field(SectionReader& section)
{
    using Field = FieldComponent::Field;
    using Component = FieldComponent::Component;
    FieldComponent field;
    field.field = section.choice<Field>("field");
    const bool vector = field.field <= Field::position;
    const bool tensor = field.field == Field::stress;
    if (section.has("component")) {
        field.component = section.choice<Component>("component");
        const bool of_vector = field.component <= Component::around, of_tensor = field.component >= Component::radial;
        if (section.sound() && ((vector && !of_vector) || (tensor && !of_tensor) || (!vector && !tensor)))
            section.error("component", vector   ? "not a component of a vector"
                                       : tensor ? "not a component of the stress"
                                                : "this field has no components");
    } else if (section.sound() && (vector || tensor))
        section.error("field", "this field needs a component",
                      vector ? "x, y, z, magnitude, radial or hoop" : "xx ... zx, radial, hoop, radial_hoop or first");
    field.centre = section.vector("centre");
    field.axis = section.axis("axis");
    return field;
}

Kind read_probe(Draft& draft, SectionReader& section)
{
    solver::Probe probe;
    probe.field = read_field(section);
    probe.point = section.optional_vector("point");
    probe.radius = section.optional_real("radius");
    probe.region = read_region(draft, section);
    if (section.has("region")) probe.over = section.choice<solver::Probe::Over>("over");
    if (section.has("point") == section.has("region")) section.error("point", "a probe has either a point or a region");
    if (section.has("point") && section.has("over")) section.error("over", "'over' belongs to a region");
    if (section.has("region") && section.has("radius")) section.error("radius", "'radius' belongs to a point");
    return probe;
}

Kind read_difference(Draft&, SectionReader& section)
{
    solver::Difference difference;
    difference.field = read_field(section);
    const std::vector<Vec3> points = section.points("points");
    if (section.sound() && points.size() != 2)
        section.error("points", "a difference has two points");
    else if (points.size() == 2) {
        difference.first = points[0];
        difference.second = points[1];
    }
    difference.radius = section.optional_real("radius");
    return difference;
}

Kind read_load(Draft& draft, SectionReader& section)
{
    solver::LoadQuantity quantity;
    const std::string name = section.text("name");
    quantity.what = section.choice<solver::LoadQuantity::What>("what");
    quantity.component = section.axis("component");
    std::vector<std::string> names;
    for (const solver::Load& load : draft.problem.loads) names.push_back(load.name);
    const std::size_t moving = names.size();
    for (const solver::SurfaceLoad& load : draft.problem.surface_loads) names.push_back(load.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        if (section.has("name")) unknown_name(draft, section.place("name"), "load", name, names);
        return quantity;
    }
    const auto index = static_cast<std::size_t>(found - names.begin());
    quantity.on_surface = index >= moving;
    quantity.load = quantity.on_surface ? index - moving : index;
    if (quantity.on_surface) {
        if (quantity.what != solver::LoadQuantity::What::force)
            section.error("what", "a load on a surface has a force only");
        return quantity;
    }
    const bool known = section.sound() && draft.loads[quantity.load].sound;
    const auto axis = static_cast<std::size_t>(quantity.component);
    if (known && quantity.what == solver::LoadQuantity::What::displacement &&
        !draft.problem.loads[quantity.load].velocity[axis])
        section.error("component",
                      fmt::format("load '{}' leaves {} free: its displacement there is 0", name, "xyz"[axis]),
                      "a probe has that of the material");
    return quantity;
}

Kind read_extent(Draft& draft, SectionReader& section)
{
    solver::Extent extent;
    extent.what = section.choice<solver::Extent::What>("what");
    extent.axis = section.axis("axis");
    extent.centre = section.vector("centre");
    extent.region = read_region(draft, section);
    if (const std::optional<std::string> name = section.optional_text("body")) {
        std::vector<std::string> names;
        for (const solver::Body& body : draft.problem.bodies) names.push_back(body.name);
        const auto found = std::find(names.begin(), names.end(), *name);
        if (found == names.end())
            unknown_name(draft, section.place("body"), "body", *name, names);
        else
            extent.body = static_cast<int>(found - names.begin());
    }
    return extent;
}

Kind read_energy(Draft&, SectionReader& section)
{
    return solver::Energy{section.choice<solver::Energy::What>("what")};
}

Kind read_momentum(Draft&, SectionReader& section)
{
    solver::Momentum momentum;
    momentum.angular = section.choice_name("what") == "angular";
    momentum.axis = section.axis("axis");
    momentum.centre = section.vector("centre");
    return momentum;
}

Kind read_volume(Draft& draft, SectionReader& section)
{
    return solver::Volume{read_region(draft, section)};
}

Kind read_field_error(Draft& draft, SectionReader& section)
{
    using Field = FieldComponent::Field;
    solver::FieldError error;
    error.motion = static_cast<std::size_t>(find_motion(draft, section, "motion").value_or(0));
    constexpr Field fields[] = {Field::displacement, Field::velocity, Field::stress};
    error.field = fields[section.choice<int>("field")];
    error.norm = section.choice<solver::FieldError::Norm>("norm");
    error.region = read_region(draft, section);
    return error;
}

Kind read_crack(Draft& draft, SectionReader& section)
{
    solver::CrackQuantity crack;
    crack.what = section.choice<solver::CrackQuantity::What>("what");
    crack.axis = section.axis("axis");
    crack.region = read_region(draft, section);
    if (section.sound() && section.has("region") && crack.what == solver::CrackQuantity::What::energy)
        section.error("region", "the energy of cracks is kept for the whole model",
                      "what = \"softening\" is that within a region, less what was stored");
    return crack;
}

/// Names of measures are looked up when all are read; see resolve_names.
Kind read_ratio(Draft&, SectionReader& section)
{
    (void)section.text("of");
    (void)section.text("over");
    return solver::Ratio{};
}

struct Reader
{
    std::string_view name;
    Kind (*read)(Draft&, SectionReader&);
};

constexpr Reader readers[] = {
    {"probe", read_probe},   {"difference", read_difference},   {"load", read_load},
    {"extent", read_extent}, {"energy", read_energy},           {"momentum", read_momentum},
    {"volume", read_volume}, {"field_error", read_field_error}, {"crack", read_crack},
    {"ratio", read_ratio},
};

solver::Reduction read_reduction(Draft& draft, SectionReader& section)
{
    using At = solver::Reduction::At;
    solver::Reduction reduction;
    const std::size_t before = draft.diagnostics.error_count();
    reduction.at = section.choice<At>("at");
    const bool known = draft.diagnostics.error_count() == before;
    reduction.time = section.optional_real("time");
    reduction.from = section.optional_real("from");
    reduction.until = section.optional_real("until");
    reduction.frequency = section.optional_real("frequency").value_or(0);
    (void)section.optional_text("of"); // looked up in resolve_names
    if (reduction.time && section.has("at")) section.error("time", "a measure has either 'at' or 'time'");
    if (reduction.from && reduction.until && *reduction.from >= *reduction.until)
        section.error("until", "the window ends before it begins");
    if (!known) return reduction;
    if ((reduction.at == At::fourier) != section.has("frequency"))
        section.error("frequency", "'frequency' and at = \"fourier\" belong together");
    if ((reduction.at == At::when_max || reduction.at == At::when_min) != section.has("of"))
        section.error("of", "'of' and at = \"when_max\" or \"when_min\" belong together");
    return reduction;
}

void check_name(Draft& draft, SectionReader& section, const std::string& name)
{
    const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    if (section.has("name") && (name.empty() || !std::all_of(name.begin(), name.end(), plain)))
        section.error("name", fmt::format("'{}' is not a name for a measure", name), "use letters, digits and _");
    for (const solver::Quantity& other : draft.problem.quantities)
        if (other.name == name) section.error("name", fmt::format("there are two measures '{}'", name));
    // Measures of every run, columns of probes.csv and sweep.csv, and what `cleave metric` says of a run itself.
    constexpr std::string_view taken[] = {"peak_force_N", "crack_path", "energy_residual", "step",   "time_ms",
                                          "run",          "status",     "distance",        "wall_s", "title",
                                          "overrides",    "reason",     "errors"};
    const auto& events = solver::event_measures;
    if (std::find(std::begin(taken), std::end(taken), name) != std::end(taken) ||
        std::find(events.begin(), events.end(), name) != events.end())
        section.error("name", fmt::format("'{}' has a meaning in the results of every run already", name),
                      "choose another name");
}

void read_quantity(Draft& draft, const Node& item)
{
    SectionReader section(draft.diagnostics, &item, "measure", "measure", item.place);
    solver::Quantity quantity;
    quantity.name = section.text("name");
    check_name(draft, section, quantity.name);
    int kinds = 0;
    for (const Reader& reader : readers) {
        const Node* value = section.find(reader.name);
        if (!value) continue;
        ++kinds;
        SectionReader own(draft.diagnostics, value, fmt::format("measure.{}", reader.name),
                          fmt::format("measure.{}", reader.name), value->place);
        quantity.kind = reader.read(draft, own);
        own.finish();
        section.record(reader.name, own);
    }
    if (kinds != 1) {
        std::vector<std::string> names;
        for (const Reader& reader : readers) names.emplace_back(reader.name);
        draft.diagnostics.error(item.place, "a measure must name exactly one kind", "",
                                {fmt::format("kinds: {}     (cleave keys measure)", joined(names))});
    }
    quantity.reduction = read_reduction(draft, section);
    quantity.scale = section.real("scale");
    quantity.reference = section.optional_real("reference");
    quantity.tolerance = section.optional_real("tolerance");
    if (quantity.tolerance && !section.has("reference")) section.error("tolerance", "a tolerance needs a reference");
    section.finish();
    draft.problem.quantities.push_back(std::move(quantity));
    Node resolved = section.resolved();
    if (section.has("time")) std::erase_if(resolved.entries, [](const Entry& entry) { return entry.key == "at"; });
    keep_item(draft, {"measure"}, std::move(resolved));
}

/// Index of the measure named at `table.key`, or 0 after an error.
std::size_t named_at(Draft& draft, const Node& table, std::string_view key, std::size_t self)
{
    const Node* value = table.find(key);
    if (!value || value->kind != Node::Kind::text) return 0;
    std::vector<std::string> names;
    for (const solver::Quantity& quantity : draft.problem.quantities) names.push_back(quantity.name);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] != value->text) continue;
        if (i == self || std::holds_alternative<solver::Ratio>(draft.problem.quantities[i].kind))
            draft.diagnostics.error(value->place, fmt::format("'{}' cannot be used here", value->text),
                                    "name another measure that is not a ratio");
        return i;
    }
    unknown_name(draft, value->place, "measure", value->text, names);
    return 0;
}

void resolve_names(Draft& draft, const Node& item, std::size_t index)
{
    solver::Quantity& quantity = draft.problem.quantities[index];
    if (item.find("of")) quantity.reduction.of = named_at(draft, item, "of", index);
    const Node* ratio = item.find("ratio");
    if (!ratio || ratio->kind != Node::Kind::table) return;
    quantity.kind = solver::Ratio{named_at(draft, *ratio, "of", index), named_at(draft, *ratio, "over", index)};
}
} // namespace

void read_quantities(Draft& draft)
{
    const Node* list = draft.root.find("measure");
    for_each_item(draft, list, "measure", [&](const Node& item) { read_quantity(draft, item); });
    std::size_t index = 0;
    for_each_item(draft, list, "measure", [&](const Node& item) { resolve_names(draft, item, index++); });
}
} // namespace io
