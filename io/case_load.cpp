#include "io/case_draft.h"

#include <fmt/format.h>

namespace io
{
namespace
{
solver::Ramp read_ramp(Draft& draft, SectionReader& load)
{
    solver::Ramp ramp{solver::Ramp::Kind::step, 0};
    const Node* value = load.find("ramp");
    if (!value) return ramp;
    SectionReader section(draft.diagnostics, value, "load.ramp", load.path() + ".ramp", value->place);
    ramp.kind = section.choice<solver::Ramp::Kind>("kind");
    ramp.time = section.real("time");
    const bool step = ramp.kind == solver::Ramp::Kind::step;
    if (section.sound() && step == (ramp.time > 0))
        section.error("time", step ? "a step has no duration" : "this ramp needs a time > 0",
                      "such as time = \"0.05 ms\"");
    section.finish();
    load.record("ramp", section);
    return ramp;
}

void read_pin(Draft& draft, SectionReader& load, solver::Load& out)
{
    const Node* value = load.find("pin");
    SectionReader section(draft.diagnostics, value, "load.pin", load.path() + ".pin", value->place);
    out.kind = solver::Load::Kind::pin;
    out.axis = section.axis("axis");
    const std::optional<std::string> feature_name = section.optional_text("feature");
    const std::optional<Vec3> centre = section.optional_vector("centre");
    const std::optional<Real> radius = section.optional_real("radius");
    const bool by_feature = section.has("feature"), by_numbers = section.has("centre") && section.has("radius");
    if (by_feature == by_numbers || (by_feature && (section.has("centre") || section.has("radius"))))
        section.error("feature", "a pin is given by a feature, or by centre and radius");
    else if (by_numbers && centre && radius) {
        out.centre = *centre;
        out.region = round_hole(*centre, out.axis, *radius);
    } else if (feature_name)
        if (const solver::Feature* feature = find_feature(draft, *feature_name, section.place("feature"))) {
            out.centre = feature->centre;
            out.region = feature->shape;
        }
    section.finish();
    load.record("pin", section);
}

void read_surface_load(Draft& draft, SectionReader& section, const std::string& name)
{
    using Kind = solver::SurfaceLoad::Kind;
    solver::SurfaceLoad load;
    load.name = name;
    if (section.has("pin") || !section.has("region"))
        section.error("region", fmt::format("load '{}' on a surface needs a region", name));
    else
        load.region = read_shape(draft, section, "region");
    const std::optional<Real> pressure = section.optional_real("pressure");
    const std::optional<Vec3> traction = section.optional_vector("traction"), force = section.optional_vector("force");
    if (section.has("pressure") + section.has("traction") + section.has("force") + section.has("velocity") != 1)
        section.error("region", fmt::format("[{}] has one of velocity, pressure, traction and force", section.path()));
    load.kind = pressure ? Kind::pressure : traction ? Kind::traction : Kind::force;
    load.pressure = pressure.value_or(0);
    load.vector = traction ? *traction : force.value_or(Vec3::Zero());
    load.facing = section.optional_vector("facing");
    if (load.facing && load.facing->norm() <= 0) section.error("facing", "a direction must not be zero");
    if (section.has("axis")) section.error("axis", "'axis' belongs to a velocity");
    load.ramp = read_ramp(draft, section);
    section.finish();
    draft.surface_loads.push_back({section.place("region"), section.sound()});
    draft.problem.surface_loads.push_back(std::move(load));
    keep(draft, {"load", name}, section.resolved());
}

void read_load(Draft& draft, const Entry& entry)
{
    SectionReader section(draft.diagnostics, &entry.value, "load", "load." + entry.key, entry.place);
    if (section.has("pressure") || section.has("traction") || section.has("force"))
        return read_surface_load(draft, section, entry.key);
    solver::Load load;
    load.name = entry.key;
    if (section.has("region") == section.has("pin"))
        section.error("region", fmt::format("[{}] needs either a region or a pin", section.path()));
    else if (section.has("pin"))
        read_pin(draft, section, load);
    else
        load.region = read_shape(draft, section, "region");
    if (section.has("facing")) section.error("facing", "'facing' belongs to a pressure, traction or force");
    if (!section.has("velocity"))
        section.error("region", fmt::format("missing key 'velocity' in [{}]", section.path()),
                      "or pressure, traction, force");
    load.velocity = section.velocity("velocity", section.optional_axis("axis"));
    load.ramp = read_ramp(draft, section);
    if (section.sound() && section.has("velocity") && !load.velocity[0] && !load.velocity[1] && !load.velocity[2])
        section.error("velocity", fmt::format("load '{}' prescribes nothing", load.name),
                      "every component is \"free\"");
    section.finish();
    draft.loads.push_back({section.has("pin") ? section.place("pin") : section.place("region"), section.sound()});
    draft.problem.loads.push_back(std::move(load));
    keep(draft, {"load", entry.key}, section.resolved());
}
} // namespace

void read_loads(Draft& draft)
{
    const Node* loads = draft.root.find("load");
    if (!loads) return;
    if (loads->kind != Node::Kind::table) {
        draft.diagnostics.error(loads->place, "loads have names", "write [load.NAME]");
        return;
    }
    for_each_named(draft, *loads, "load", [&](const Entry& entry) { read_load(draft, entry); });
}
} // namespace io
