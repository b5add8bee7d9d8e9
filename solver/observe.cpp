#include "solver/observe.h"

#include "solver/audit.h"
#include "solver/external_force.h"
#include "solver/ligament_events.h"
#include "solver/measures.h"
#include "solver/nodal.h"

#include <algorithm>
#include <cmath>

namespace solver
{
namespace
{
Real mean_displacement(const Problem& problem, const State& state, const std::vector<std::uint32_t>& places, int axis)
{
    const particles::Particles& particles = state.particles;
    const auto column = static_cast<std::size_t>(axis);
    Real sum = 0;
    for (const std::uint32_t p : places)
        sum += nodal(problem) ? transfer::displacement_of(particles, state.levels, p)[axis]
                              : particles.position[column][p] - particles.rest_position[column][p];
    return places.empty() ? Real(0) : sum / static_cast<Real>(places.size());
}

std::uint64_t particles_on(const grid::Levels& levels, int level)
{
    return levels.cell_start[levels.first_leaf(level + 1) * grid::leaf_cells] -
           levels.cell_start[levels.first_leaf(level) * grid::leaf_cells];
}

/// Mean reaction of a named load since the last line, full specimen, positive along `sign`.
Real mean_force(const Problem& problem, const Derived& derived, const State& state, const std::string& name, Real sign)
{
    for (std::size_t i = 0; i < problem.loads.size(); ++i)
        if (problem.loads[i].name == name && state.loads[i].impulse_time > 0)
            return sign * problem.symmetry_factor(problem.force_axis) * state.loads[i].impulse[problem.force_axis] /
                   state.loads[i].impulse_time;
    for (std::size_t i = 0; i < problem.surface_loads.size(); ++i)
        if (problem.surface_loads[i].name == name)
            return sign * surface_force(problem, derived, i, problem.force_axis, state.clock.time);
    return 0;
}
} // namespace

Real gauge_opening(const Problem& problem, const State& state, const Derived& derived)
{
    if (!problem.gauge) return 0;
    return mean_displacement(problem, state, derived.gauge_upper, problem.gauge->axis) -
           mean_displacement(problem, state, derived.gauge_lower, problem.gauge->axis) - state.gauge_start;
}

std::vector<std::uint64_t> particles_per_level(const State& state)
{
    const grid::Levels& levels = state.levels;
    std::vector<std::uint64_t> count;
    for (int l = 0; l < levels.count; ++l) count.push_back(particles_on(levels, l));
    return count;
}

std::uint64_t updates_per_step(const Problem& problem, const State& state)
{
    if (!problem.numerics.subcycling) return state.particles.size();
    std::uint64_t updates = 0;
    for (int l = 0; l < state.levels.count; ++l) updates += particles_on(state.levels, l) << l;
    return updates;
}

HistoryLine observe(const Problem& problem, const Prepared& prepared, const Derived& derived, State& state)
{
    HistoryLine line;
    line.step = state.clock.step;
    line.time = state.clock.time;
    line.dt = state.clock.dt;
    line.force_upper = mean_force(problem, derived, state, problem.force_upper, 1);
    line.force_lower = mean_force(problem, derived, state, problem.force_lower, -1);
    line.cod = gauge_opening(problem, state, derived);
    line.energy = audit(prepared, state);
    for (const core::Crack& crack : state.particles.cracks) {
        line.max_damage = std::max(line.max_damage, crack.damage);
        line.separated_particles += crack.damage >= 1 ? 1 : 0;
    }
    line.particles = particles_per_level(state);
    for (LoadState& load : state.loads) {
        load.impulse.setZero();
        load.impulse_time = 0;
    }
    const Observation now{line.time, specimen_force(problem, line.force_upper, line.force_lower), line.cod};
    const std::vector<LigamentState> before = state.ligaments;
    update_ligaments(derived.ligaments, state.particles, now, state.ligaments);
    log_events(before, state.ligaments, line.step, now, state.events);
    state.history.push_back(line);
    return line;
}

Finish finished(const Problem& problem, const State& state)
{
    // The tolerance keeps a clock that sums steps from adding one for the last bit.
    if (state.clock.time >= problem.end.time * (1 - 1e-12)) return Finish::time;
    if (state.history.empty()) return Finish::no;
    const HistoryLine& last = state.history.back();
    if (last.cod >= problem.end.cod) return Finish::cod;
    if (!problem.end.separated || last.separated_particles == 0) return Finish::no;
    const auto force = [&](const HistoryLine& line) {
        return std::abs(specimen_force(problem, line.force_upper, line.force_lower));
    };
    Real peak = 0;
    for (const HistoryLine& line : state.history) peak = std::max(peak, force(line));
    // One quiet line may be ringing; ten in a row are not.
    constexpr std::size_t quiet_lines = 10;
    if (state.history.size() < quiet_lines || peak <= 0) return Finish::no;
    for (std::size_t n = state.history.size() - quiet_lines; n < state.history.size(); ++n)
        if (force(state.history[n]) > separated_share * peak) return Finish::no;
    return Finish::separated;
}
} // namespace solver
