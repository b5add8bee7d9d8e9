#include "io/case_draft.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace io
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

enum class Preset
{
    none,
    paper,
    objective,
};

enum class Mode
{
    mixed,
    opening,
    shear,
};

/// Constants of Yang et al. 2014 in mm-g-ms.
namespace paper
{
constexpr Real s_max = 4900;  // MPa
constexpr Real tau_max = 820; // MPa
constexpr Real u0 = 2e-4;     // mm
} // namespace paper

Real read_strength(SectionReader& section, std::string_view name, bool switched_off, std::optional<Real> preset)
{
    const Real given = section.optional_real(name).value_or(preset.value_or(0));
    if (!switched_off && !section.has(name) && !preset)
        section.error(name, fmt::format("missing key '{}' in [{}]", name, section.path()),
                      "or preset = \"paper\", or mode = \"opening\" or \"shear\"");
    const Real strength = switched_off ? infinity : given;
    section.record(name, node(strength));
    return strength;
}

void read_mode_ratios(SectionReader& section, material::Decohesion& law, Diagnostics& diagnostics)
{
    if (const Node* one = section.find("c_m")) {
        const Real ratio = read_real(*one, key_of("material.decohesion", "c_m"), diagnostics).value_or(1);
        for (const std::string_view name : {"c_m_opening", "c_m_shear", "c_m_mixed"}) {
            if (section.has(name)) section.error(name, fmt::format("give either c_m for all modes or '{}'", name));
            section.record(name, node(ratio));
        }
        law.c_m_opening = law.c_m_shear = law.c_m_mixed = ratio;
        return;
    }
    law.c_m_opening = section.real("c_m_opening");
    law.c_m_shear = section.real("c_m_shear");
    law.c_m_mixed = section.real("c_m_mixed");
}

material::Decohesion read_decohesion(Draft& draft, SectionReader& section)
{
    material::Decohesion law;
    const Preset preset = section.choice<Preset>("preset");
    const Mode mode = section.choice<Mode>("mode");
    // After a misspelt name nothing is missed: the paper's constants stand in for what was meant.
    const bool as_paper = preset == Preset::paper || !section.sound();
    law.s_max =
        read_strength(section, "s_max", mode == Mode::shear, as_paper ? std::optional(paper::s_max) : std::nullopt);
    law.tau_max = read_strength(section, "tau_max", mode == Mode::opening,
                                as_paper ? std::optional(paper::tau_max) : std::nullopt);
    law.tau_max_axial = section.optional_real("tau_max_axial");
    if (law.tau_max == infinity) law.tau_max_axial.reset(); // no mode II at all
    law.q = section.real("q");
    law.u0 = section.optional_real("u0");
    law.energy_1 = section.optional_real("G_I");
    law.energy_2 = section.optional_real("G_II");
    const bool energies = section.has("G_I") || section.has("G_II");
    if (as_paper && !section.has("u0") && !energies) law.u0 = section.real("u0", paper::u0);
    if (section.has("u0") && energies)
        section.error("u0", "give either u0 or the energies G_I and G_II, not both");
    else if (energies && !(section.has("G_I") && section.has("G_II")))
        section.error(section.has("G_I") ? "G_I" : "G_II", "the energies of both modes are needed: G_I and G_II");
    else if (preset == Preset::objective && !energies)
        section.error("preset", "preset \"objective\" needs the fracture energies G_I and G_II");
    else if (!section.has("u0") && !energies && !as_paper)
        section.error("u0", fmt::format("[{}] has no energy", section.path()), "give u0, or G_I and G_II");
    read_mode_ratios(section, law, draft.diagnostics);
    law.band_factor = section.real("band_factor");
    law.snap_back = section.choice("snap_back", as_paper ? material::SnapBack::brittle_drop : law.snap_back);
    law.energy_floor_factor = section.real("energy_floor_factor");
    law.drop_transits = section.real("drop_transits");
    law.onset_strength = section.choice<material::OnsetStrength>("onset_strength");
    law.smoothed_onset = section.boolean("smoothed_onset", !as_paper);
    law.nonlocal_radius = section.real("nonlocal_radius");
    law.crack_exclusion = section.real("crack_exclusion", law.nonlocal_radius);
    law.lode_memory = section.real("lode_memory");
    for (const auto& [key, value] :
         {std::pair("crack_exclusion", law.crack_exclusion), std::pair("lode_memory", law.lode_memory)})
        if (value > 0 && law.nonlocal_radius == 0)
            section.error(key, fmt::format("{} belongs to the nonlocal onset", key), "add a nonlocal_radius");
    if (law.lode_memory > 0 && !section.has("tau_max_axial"))
        section.error("lode_memory", "without tau_max_axial all states have one strength", "add tau_max_axial");
    if (const std::optional<Vec3> plane = section.optional_vector("weak_plane")) {
        if (plane->norm() == 0) section.error("weak_plane", "a plane needs a normal other than zero");
        const Vec3 unit = plane->normalized();
        law.weak_plane = {unit[0], unit[1], unit[2]};
    }
    if (law.weak_plane && section.has("tau_max_axial"))
        section.error("tau_max_axial", "a weak_plane compares the shear on it with tau_max alone",
                      "leave out one of the two keys");
    law.rotating_until = section.real("rotating_until");
    if (law.weak_plane && law.rotating_until > 0)
        section.error("rotating_until", "a weak_plane does not rotate", "leave out one of the two keys");
    law.renewed_plane = section.boolean("renewed_plane");
    law.second_crack = section.boolean("second_crack");
    if (law.weak_plane && law.renewed_plane)
        section.error("renewed_plane", "a weak_plane stays where it is", "leave out one of the two keys");
    if (law.weak_plane && law.second_crack)
        section.error("second_crack", "a weak_plane is the only plane that can break", "leave out one of the two keys");
    law.friction = section.real("friction");
    return law;
}

void read_material(Draft& draft, const Entry& entry)
{
    SectionReader section(draft.diagnostics, &entry.value, "material", "material." + entry.key, entry.place);
    material::Material material;
    material.name = entry.key;
    material.elastic.density = section.real("density");
    material.elastic.youngs_modulus = section.real("youngs_modulus");
    material.elastic.poisson_ratio = section.real("poisson_ratio");
    const std::optional<Real> yield = section.optional_real("yield_stress");
    const std::optional<Real> tangent = section.optional_real("tangent_modulus");
    if (yield) material.plastic = material::VonMises{*yield, tangent.value_or(0)};
    if (tangent && !section.has("yield_stress"))
        section.error("tangent_modulus", "a tangent modulus needs a yield_stress");
    if (tangent && *tangent >= material.elastic.youngs_modulus)
        section.error("tangent_modulus",
                      fmt::format("tangent_modulus {} MPa is not below youngs_modulus {} MPa", *tangent,
                                  material.elastic.youngs_modulus),
                      "it is d(stress)/d(strain) after yield");
    enum class Dilatation
    {
        cell,
        point,
    };
    material.cell_averaged_dilatation = section.choice<Dilatation>("dilatation") == Dilatation::cell;
    if (const Node* value = section.find("decohesion")) {
        SectionReader own(draft.diagnostics, value, "material.decohesion", section.path() + ".decohesion",
                          value->place);
        material.decohesion = read_decohesion(draft, own);
        own.finish();
        section.record("decohesion", own.resolved());
    }
    section.finish();
    draft.materials.push_back({entry.place, section.sound()});
    draft.problem.materials.push_back(std::move(material));
    keep(draft, {"material", entry.key}, section.resolved());
}
} // namespace

void read_materials(Draft& draft)
{
    const Node* materials = draft.root.find("material");
    if (!materials || materials->kind != Node::Kind::table || materials->entries.empty()) {
        draft.diagnostics.error(materials ? materials->place : draft.root.place, "the case has no material",
                                "add a table [material.NAME]");
        return;
    }
    for_each_named(draft, *materials, "material", [&](const Entry& entry) { read_material(draft, entry); });
}
} // namespace io
