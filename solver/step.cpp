#include "solver/step.h"

#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/momentum.h"
#include "grid/nodal.h"
#include "solver/damping.h"
#include "solver/external_force.h"
#include "solver/follow.h"
#include "solver/nodal.h"
#include "solver/nonlocal.h"
#include "solver/stable_time_step.h"

#include <algorithm>
#include <bit>

namespace solver
{
namespace
{
transfer::PassOptions pass_options(const Prepared& prepared, const Clock& clock)
{
    transfer::PassOptions options = prepared.options;
    options.dt = clock.dt;
    options.time = clock.time + clock.dt;
    return options;
}

void choose_dt(const Problem& problem, const Prepared& prepared, State& state)
{
    const int nested = substeps(problem);
    if (state.clock.step % std::max(1, time_step_interval / nested) == 0)
        state.clock.dt = nested * stable_time_step(problem, prepared, state);
}

/// Node velocities of all levels from the particles' sums.
void move_nodes(const Problem& problem, const Prepared& prepared, Derived& derived, State& state)
{
    const Real time = state.clock.time;
    const Real dt = state.clock.dt;
    add_external_forces(problem, state, derived);
    grid::assemble_sums(state.levels);
    grid::restrict_sums(state.levels);
    grid::advance_momentum(prepared.walls, problem.gravity, prepared.mass_cutoff, dt, state.levels);
    damp_nodes(problem, derived, state);
    apply_loads(problem, prepared, derived.load_nodes, time, dt, state.levels, state.loads);
    grid::prolong_motion(state.levels);
    grid::fill_motion_halos(state.levels);
    add_external_work(problem, derived, state);
}

/// Node velocities mapped again from the updated particles, into `change`.
void move_nodes_again(const Problem& problem, const Prepared& prepared, const Derived& derived, State& state)
{
    grid::assemble_momentum(state.levels);
    grid::restrict_momentum(state.levels);
    grid::remap_velocity(prepared.walls, prepared.mass_cutoff, state.levels);
    hold_loads(problem, derived.load_nodes, state.levels);
    grid::prolong_motion(state.levels);
    grid::fill_motion_halos(state.levels);
}

void tick(Clock& clock)
{
    clock.time += clock.dt;
    ++clock.step;
}
} // namespace

void step(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    choose_dt(problem, prepared, state);
    const transfer::PassOptions options = pass_options(prepared, state.clock);

    move_nodes(problem, prepared, derived, state);
    if (problem.numerics.stress_update == StressUpdate::musl) {
        transfer::remap_momentum(options, state.strays, state.particles, state.levels);
        move_nodes_again(problem, prepared, derived, state);
    }

    transfer::advance_and_scatter(options, prepared.laws, state.strays, state.particles, state.levels, state.leaf_work);
    start_nonlocal_cracks(options, prepared, state, derived.nonlocal);

    tick(state.clock);
    follow_particles(problem, prepared, state, derived);
}

void step_nodal(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    choose_dt(problem, prepared, state);
    const transfer::PassOptions options = pass_options(prepared, state.clock);

    add_external_forces(problem, state, derived);
    add_external_work(problem, derived, state);
    grid::advance_nodes(prepared.walls, problem.gravity, {state.clock.dt}, state.levels);
    damp_nodes(problem, derived, state);
    apply_loads(problem, prepared, derived.load_nodes, state.clock.time, state.clock.dt, state.levels, state.loads);
    grid::prolong_motion(state.levels);
    grid::fill_motion_halos(state.levels);
    add_external_work(problem, derived, state);

    transfer::advance_lattice(options, prepared.laws, state.lattice, state.particles, state.levels, state.leaf_work);
    start_nonlocal_cracks(options, prepared, state, derived.nonlocal);

    tick(state.clock);
}

void step_subcycled(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    choose_dt(problem, prepared, state);
    const auto count = static_cast<unsigned>(substeps(problem));
    const int finest = state.levels.count - 1;
    grid::LevelSteps steps{state.clock.dt / count, 0, finest, true};
    transfer::PassOptions options = pass_options(prepared, state.clock);
    for (unsigned n = 0; n < count; ++n) {
        steps.first = n == 0 ? 0 : finest - std::countr_zero(n); // whose step begins
        grid::advance_nodes(prepared.walls, problem.gravity, steps, state.levels);
        apply_loads(problem, prepared, derived.load_nodes, state.clock.time, steps.dt, state.levels, state.loads);
        grid::drift_fast_nodes(steps.dt, state.levels, derived.fast_nodes);
        state.clock.time += steps.dt;

        steps.first = finest - std::countr_zero(n + 1); // whose step ends
        grid::prolong_displacement(steps, state.levels);
        grid::average_fast_nodes(steps, state.levels, derived.fast_nodes);
        grid::fill_motion_halos(state.levels, steps.first);

        options.time = state.clock.time;
        transfer::advance_lattice(steps, options, prepared.laws, state.lattice, state.particles, state.levels,
                                  state.leaf_work);
        grid::release_fast_nodes(steps, state.levels, derived.fast_nodes);
    }
    start_nonlocal_cracks(options, prepared, state, derived.nonlocal);
    ++state.clock.step;
}

void advance(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    if (problem.numerics.subcycling) return step_subcycled(problem, prepared, state, derived);
    if (nodal(problem)) return step_nodal(problem, prepared, state, derived);
    step(problem, prepared, state, derived);
}
} // namespace solver
