#include "io/case_draft.h"
#include "io/particle_fields.h"
#include "solver/stable_time_step.h"

#include <fmt/format.h>

#include <cmath>

namespace io
{
namespace
{
solver::OutputEvery read_every(Draft& draft, SectionReader& section)
{
    solver::OutputEvery every;
    every.time = section.optional_real("every_time");
    every.steps = section.optional_integer("every_steps");
    every.cod = section.optional_real("every_cod");
    if (every.cod && draft.every_cod.file < 0) draft.every_cod = section.place("every_cod");
    return every;
}

void check_particle_fields(Draft& draft, SectionReader& section, const std::vector<std::string>& fields)
{
    std::vector<std::string> known;
    for (const ParticleField& field : particle_fields) known.emplace_back(field.name);
    for (std::size_t i = 0; i < fields.size(); ++i)
        if (!find_particle_field(fields[i]) && section.sound())
            unknown_name(draft, section.find("fields")->items[i].place, "particle field", fields[i], known);
}

/// A section "output.<name>", read by `read` and kept.
template <class Read>
void read_part(Draft& draft, const Node* output, const std::string& name, const Read& read)
{
    const Node* table = output ? output->find(name) : nullptr;
    SectionReader section(draft.diagnostics, table, "output." + name, "output." + name, draft.root.place);
    read(section);
    section.finish();
    keep(draft, {"output", name}, section.resolved());
}
} // namespace

void read_numerics(Draft& draft)
{
    SectionReader section(draft.diagnostics, draft.root.find("numerics"), "numerics", "numerics", draft.root.place);
    solver::Numerics& numerics = draft.problem.numerics;
    numerics.formulation = section.choice<solver::Formulation>("formulation");
    numerics.basis = section.choice<solver::Basis>("basis");
    if (numerics.basis == solver::Basis::gimp && numerics.formulation == solver::Formulation::total)
        draft.diagnostics.warning(section.place("basis"), "basis = \"gimp\" changes nothing in the total formulation",
                                  "boxes never leave their cells there; gimp is for formulation = \"updated\"");
    numerics.stress_update = section.choice("stress_update", numerics.formulation == solver::Formulation::updated
                                                                 ? solver::StressUpdate::musl
                                                                 : solver::StressUpdate::usl);
    numerics.pic_fraction = section.real("pic_fraction");
    numerics.damping = section.real("damping");
    numerics.damping_memory = section.real("damping_memory");
    numerics.cfl = section.real("cfl");
    numerics.mass_cutoff = section.real("mass_cutoff");
    const bool lattice = numerics.formulation == solver::Formulation::total &&
                         numerics.stress_update == solver::StressUpdate::usl &&
                         draft.problem.grid.particles_per_cell == 8;
    numerics.transfer = section.choice("transfer", lattice && numerics.pic_fraction == 0 ? solver::Transfer::nodal
                                                                                         : solver::Transfer::flip);
    numerics.precision = section.choice(
        "precision", numerics.transfer == solver::Transfer::nodal ? solver::Precision::mixed : solver::Precision::f64);
    if (numerics.precision == solver::Precision::mixed && numerics.transfer != solver::Transfer::nodal)
        section.error("precision", "precision = \"mixed\" needs transfer = \"nodal\"");
    numerics.subcycling = section.boolean("subcycling");
    if (numerics.subcycling && numerics.transfer != solver::Transfer::nodal)
        section.error("subcycling", "subcycling = true needs transfer = \"nodal\"");
    if (numerics.subcycling && numerics.cfl > solver::subcycled_step_share)
        section.error(
            "cfl", fmt::format("cfl must be at most {} with subcycling: steps of neighbouring levels resonate beyond",
                               solver::subcycled_step_share));
    if (numerics.subcycling && numerics.damping > 0)
        section.error("damping", "damping is not built for steps that differ between levels (subcycling = true)");
    if (!std::isinf(numerics.damping_memory) && numerics.damping == 0)
        draft.diagnostics.warning(section.place("damping_memory"), "damping_memory changes nothing without damping");
    if (numerics.damps_fast_motion_only() && numerics.transfer != solver::Transfer::nodal)
        section.error("damping_memory", "damping_memory needs transfer = \"nodal\": the nodes keep the means");
    if (numerics.subcycling && draft.problem.grid.levels == 1)
        draft.diagnostics.warning(section.place("subcycling"), "subcycling = true changes nothing on one level");
    if (numerics.cfl >= 1) section.error("cfl", "cfl must be below 1: the explicit step is unstable beyond");
    if (numerics.transfer != solver::Transfer::flip && numerics.pic_fraction > 0)
        section.error("pic_fraction", "pic_fraction belongs to transfer = \"flip\"");
    if (numerics.transfer == solver::Transfer::nodal && !lattice)
        section.error("transfer",
                      "transfer = \"nodal\" needs formulation = \"total\", stress_update = \"usl\" and "
                      "grid.particles_per_cell = 8",
                      "choose \"flip\" or \"apic\"");
    section.finish();
    keep(draft, {"numerics"}, section.resolved());
}

void read_end(Draft& draft)
{
    SectionReader section(draft.diagnostics, draft.root.find("end"), "end", "end", draft.root.place);
    solver::End& end = draft.problem.end;
    end.time = section.real("time");
    end.cod = section.real("cod");
    end.separated = section.boolean("separated");
    if (section.sound() && std::isinf(end.time) && std::isinf(end.cod))
        section.error("time", "the run has no end", "give [end] a time or a cod");
    section.finish();
    draft.end = {section.place("cod"), section.sound()};
    keep(draft, {"end"}, section.resolved());
}

void read_output(Draft& draft)
{
    const Node* table = draft.root.find("output");
    SectionReader(draft.diagnostics, table, "output", "output", draft.root.place).finish();
    solver::Output& output = draft.problem.output;
    read_part(draft, table, "history", [&](SectionReader& section) {
        output.history = read_every(draft, section);
        if (output.history.time || output.history.steps || output.history.cod) return;
        output.history.steps = 100;
        section.record("every_steps", node(std::int64_t{100}));
    });
    read_part(draft, table, "probes", [&](SectionReader& section) { output.probes = read_every(draft, section); });
    read_part(draft, table, "particles", [&](SectionReader& section) {
        output.particles = read_every(draft, section);
        output.particle_fields = section.distinct_names("fields");
        output.particle_precision = section.choice_name("precision");
        check_particle_fields(draft, section, output.particle_fields);
    });
    read_part(draft, table, "grid", [&](SectionReader& section) {
        output.grid = read_every(draft, section);
        output.grid_fields = section.distinct_names("fields");
    });
    read_part(draft, table, "vdb", [&](SectionReader& section) {
        output.vdb = read_every(draft, section);
        output.vdb_grids = section.distinct_names("grids");
        output.vdb_preset = section.choice_name("preset");
        output.vdb_scale = section.real("scale");
    });
    read_part(draft, table, "checkpoint", [&](SectionReader& section) {
        output.checkpoint_every_wall = section.real("every_wall");
        output.checkpoint_keep = section.integer("keep");
        output.checkpoint_at_end = section.boolean("at_end");
    });
}
} // namespace io
