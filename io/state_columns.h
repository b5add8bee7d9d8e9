/// Every member of the small structs of solver::State by name, for the checkpoint. `visit(name, member)` is called for
/// each; a member is a Real or an integer. The asserts on sizes catch a member that was added there and forgotten here.
#pragma once

#include "particles/particles.h"
#include "solver/state.h"

#include <string>
#include <utility>

namespace io
{
template <class Array, class Visit>
void visit_array(const std::string& name, Array& array, Visit& visit)
{
    for (std::size_t i = 0; i < static_cast<std::size_t>(array.size()); ++i)
        visit(name + "_" + std::to_string(i), array.data()[i]);
}

template <class Visit>
void visit_members(particles::Crack& crack, Visit&& visit)
{
    static_assert(sizeof(particles::Crack) == 18 * sizeof(Real) + 2 * sizeof(std::int32_t));
    visit_array("normal", crack.normal, visit);
    visit("damage", crack.damage);
    visit("opening", crack.opening);
    visit_array("slip", crack.slip, visit);
    visit("normal_strength", crack.normal_strength);
    visit("tangential_strength", crack.tangential_strength);
    visit("effective_length", crack.effective_length);
    visit("surface_energy", crack.surface_energy);
    visit("snap_back_ratio", crack.snap_back_ratio);
    visit("onset_time", crack.onset_time);
    visit("separation_time", crack.separation_time);
    visit("second_time", crack.second_time);
    visit_array("drop_traction", crack.drop_traction, visit);
    visit("mode", crack.mode);
    visit("particle_id", crack.particle_id);
}

template <class Visit>
void visit_members(solver::Clock& clock, Visit&& visit)
{
    static_assert(sizeof(solver::Clock) == 3 * sizeof(Real));
    visit("step", clock.step);
    visit("time", clock.time);
    visit("dt", clock.dt);
}

template <class Visit>
void visit_members(solver::LoadState& load, Visit&& visit)
{
    static_assert(sizeof(solver::LoadState) == 17 * sizeof(Real));
    visit_array("displacement", load.displacement, visit);
    visit("angle", load.angle);
    visit("spin", load.spin);
    visit_array("reaction", load.reaction, visit);
    visit_array("impulse", load.impulse, visit);
    visit("impulse_time", load.impulse_time);
    visit_array("sample_impulse", load.sample_impulse, visit);
    visit("sample_time", load.sample_time);
    visit("external_work", load.external_work);
}

template <class Visit>
void visit_members(solver::LigamentState& ligament, Visit&& visit)
{
    static_assert(sizeof(solver::LigamentState) == 10 * sizeof(Real));
    visit("onset_time", ligament.onset_time);
    visit("onset_force", ligament.onset_force);
    visit("onset_cod", ligament.onset_cod);
    visit("first_time", ligament.first_time);
    visit("first_force", ligament.first_force);
    visit("first_cod", ligament.first_cod);
    visit("through_time", ligament.through_time);
    visit("through_force", ligament.through_force);
    visit("through_cod", ligament.through_cod);
    visit("front", ligament.front);
}

template <class Visit>
void visit_members(solver::LigamentEvent& event, Visit&& visit)
{
    static_assert(sizeof(solver::LigamentEvent) == 6 * sizeof(Real));
    visit("step", event.step);
    visit("time", event.time);
    visit("force", event.force);
    visit("cod", event.cod);
    visit("front", event.front);
    visit("ligament", event.ligament);
    visit("kind", event.kind);
}

template <class Visit>
void visit_members(solver::LeafWork& work, Visit&& visit)
{
    static_assert(sizeof(solver::LeafWork) == 2 * sizeof(Real));
    visit("plastic", work.plastic);
    visit("decohesion", work.decohesion);
}

/// All but the particle counts, whose number is that of the levels.
template <class Visit>
void visit_members(solver::HistoryLine& line, Visit&& visit)
{
    static_assert(sizeof(solver::Ledger) == 7 * sizeof(Real));
    static_assert(sizeof(solver::HistoryLine) == 15 * sizeof(Real) + sizeof(std::vector<std::uint64_t>));
    visit("step", line.step);
    visit("time", line.time);
    visit("dt", line.dt);
    visit("force_upper", line.force_upper);
    visit("force_lower", line.force_lower);
    visit("cod", line.cod);
    visit("kinetic", line.energy.kinetic);
    visit("elastic", line.energy.elastic);
    visit("plastic", line.energy.plastic);
    visit("decohesion", line.energy.decohesion);
    visit("external", line.energy.external);
    visit("initial", line.energy.initial);
    visit("damping", line.energy.damping);
    visit("max_damage", line.max_damage);
    visit("separated_particles", line.separated_particles);
}
} // namespace io
