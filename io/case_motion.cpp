#include "io/case_draft.h"

#include <fmt/format.h>

#include <cmath>

namespace io
{
namespace
{
using solver::WaveKind;

solver::Spin read_spin(SectionReader& section)
{
    solver::Spin spin;
    spin.centre = section.vector("centre");
    spin.axis = section.axis("axis");
    spin.omega = section.real("omega");
    spin.velocity = section.vector("velocity");
    return spin;
}

/// What both waves have.
template <class Wave>
Wave read_wave(SectionReader& section)
{
    Wave wave;
    wave.axis = section.axis("axis");
    wave.wave = section.choice<WaveKind>("wave");
    wave.direction = section.optional_axis("direction").value_or(wave.axis);
    if (section.sound() && (wave.direction == wave.axis) == (wave.wave == WaveKind::shear))
        section.error("direction", wave.wave == WaveKind::shear ? "a shear wave needs a direction other than its axis"
                                                                : "only a shear wave moves across its axis");
    wave.wavelength = section.real("wavelength");
    wave.start = section.real("start");
    wave.speed = section.real("speed");
    return wave;
}

solver::StandingWave read_standing_wave(SectionReader& section)
{
    auto wave = read_wave<solver::StandingWave>(section);
    wave.phase = section.real("phase");
    return wave;
}

solver::Packet read_packet(SectionReader& section)
{
    auto packet = read_wave<solver::Packet>(section);
    packet.width = section.real("width");
    return packet;
}

solver::BoxWave read_box_wave(SectionReader& section)
{
    solver::BoxWave wave;
    wave.corner = section.vector("corner");
    wave.edge = section.real("edge");
    wave.amplitude = section.real("amplitude");
    wave.half_waves = section.integer("half_waves");
    wave.phase = section.vector("phase");
    return wave;
}

template <class Round>
Round read_round(SectionReader& section)
{
    Round round;
    round.centre = section.vector("centre");
    round.axis = section.axis("axis");
    round.inner = section.real("inner");
    round.outer = section.real("outer");
    if (section.sound() && round.inner >= round.outer)
        section.error("outer", "the outer radius must be the larger one");
    return round;
}

solver::Vortex read_vortex(SectionReader& section)
{
    auto vortex = read_round<solver::Vortex>(section);
    vortex.angle = section.real("angle");
    vortex.period = section.real("period");
    return vortex;
}

solver::Ring read_ring(SectionReader& section)
{
    auto ring = read_round<solver::Ring>(section);
    ring.amplitude = section.real("amplitude");
    return ring;
}

/// Reads the table of the kind into `motion`.
template <class Read>
bool try_kind(Draft& draft, SectionReader& section, std::string_view name, const Read& read, solver::Motion& motion)
{
    const Node* value = section.find(name);
    if (!value) return false;
    SectionReader own(draft.diagnostics, value, fmt::format("motion.{}", name),
                      fmt::format("{}.{}", section.path(), name), value->place);
    motion.kind = read(own);
    own.finish();
    section.record(name, own);
    return true;
}

void read_motion(Draft& draft, const Entry& entry)
{
    SectionReader section(draft.diagnostics, &entry.value, "motion", "motion." + entry.key, entry.place);
    solver::Motion motion;
    motion.name = entry.key;
    const std::string material = section.text("material");
    if (section.sound()) {
        const std::size_t index = static_cast<std::size_t>(material_index(draft, material, section.place("material")));
        if (index < draft.problem.materials.size()) motion.elastic = draft.problem.materials[index].elastic;
    }
    int kinds = 0;
    kinds += try_kind(draft, section, "spin", read_spin, motion);
    kinds += try_kind(draft, section, "standing_wave", read_standing_wave, motion);
    kinds += try_kind(draft, section, "packet", read_packet, motion);
    kinds += try_kind(draft, section, "box_wave", read_box_wave, motion);
    kinds += try_kind(draft, section, "vortex", read_vortex, motion);
    kinds += try_kind(draft, section, "ring", read_ring, motion);
    if (kinds != 1)
        draft.diagnostics.error(
            entry.place, fmt::format("[{}] must name exactly one kind of motion", section.path()), "",
            {"kinds: spin, standing_wave, packet, box_wave, vortex, ring     (cleave keys motion)"});
    if (section.sound() && std::holds_alternative<solver::Ring>(motion.kind) && motion.elastic.poisson_ratio != 0)
        section.error("ring", "the rims of this motion are free of stress only for poisson_ratio = 0");
    section.finish();
    draft.problem.motions.push_back(std::move(motion));
    keep(draft, {"motion", entry.key}, section.resolved());
}
} // namespace

void read_motions(Draft& draft)
{
    const Node* motions = draft.root.find("motion");
    if (!motions) return;
    if (motions->kind != Node::Kind::table) {
        draft.diagnostics.error(motions->place, "motions have names", "write [motion.NAME]");
        return;
    }
    for_each_named(draft, *motions, "motion", [&](const Entry& entry) { read_motion(draft, entry); });
}

std::optional<int> find_motion(Draft& draft, SectionReader& section, std::string_view key)
{
    const std::optional<std::string> name = section.optional_text(key);
    if (!name) return std::nullopt;
    std::vector<std::string> names;
    for (const solver::Motion& motion : draft.problem.motions) names.push_back(motion.name);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == *name) return static_cast<int>(i);
    unknown_name(draft, section.place(key), "motion", *name, names);
    return std::nullopt;
}
} // namespace io
