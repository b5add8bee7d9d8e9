#include "solver/follow.h"

#include "refine/regrid.h"
#include "transfer/gimp_cover.h"

#include <algorithm>

namespace solver
{
namespace
{
std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& ids, const particles::Particles& particles)
{
    std::vector<std::uint32_t> places;
    for (std::uint32_t p = 0; p < particles.size(); ++p)
        if (std::binary_search(ids.begin(), ids.end(), particles.id[p])) places.push_back(p);
    // In id order, so that sums over them do not depend on the present order of particles.
    std::sort(places.begin(), places.end(),
              [&](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
    return places;
}

void fold_work(State& state)
{
    for (const LeafWork& work : state.leaf_work) {
        state.folded_work.plastic += work.plastic;
        state.folded_work.decohesion += work.decohesion;
    }
    state.leaf_work.assign(state.levels.leaves.size(), {});
}
} // namespace

void fit_cells(const Prepared& prepared, grid::Refinement& refinement, State& state)
{
    transfer::refine_voids(prepared.options, state.levels, state.particles, refinement);
    refine::split_into_finer_cells(state.levels, refinement, prepared.per_axis, state.particles);
}

void order_cells(const Problem& problem, const Prepared& prepared, const grid::Refinement& refinement, State& state)
{
    refine::order(problem.numerics.formulation, refinement, state.levels, state.particles);
    transfer::cover_boxes(prepared.options, refinement, state.particles, state.levels);
}

void find_places(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    transfer::assign_all(prepared.options, state.particles, state.levels, state.strays);
    find_load_nodes(problem, state.levels, state.loads, derived.load_nodes);
    derived.gauge_upper = places_of(state.gauge_upper, state.particles);
    derived.gauge_lower = places_of(state.gauge_lower, state.particles);
    weigh_columns(state.particles, derived.ligaments);
    derived.surface = find_surface_forces(problem, state.particles, prepared);
    derived.nonlocal = {};
}

void regrid(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    grid::Refinement refinement = refine::refinement_from_targets(state.levels, state.particles);
    fit_cells(prepared, refinement, state);
    order_cells(problem, prepared, refinement, state);
    fold_work(state);
    find_places(problem, prepared, state, derived);
    transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
}

void follow_particles(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    if (problem.numerics.formulation == Formulation::total) return;
    if (transfer::worth_reordering(prepared.options, state.strays, state.particles)) {
        regrid(problem, prepared, state, derived);
    } else if (load_nodes_outdated(problem, state.loads, derived.load_nodes)) {
        find_load_nodes(problem, state.levels, state.loads, derived.load_nodes);
    }
}
} // namespace solver
