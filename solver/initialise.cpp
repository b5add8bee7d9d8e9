#include "core/error.h"
#include "grid/damping.h"
#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/topology.h"
#include "refine/populate.h"
#include "refine/regrid.h"
#include "solver/audit.h"
#include "solver/begin_motion.h"
#include "solver/follow.h"
#include "solver/lattice.h"
#include "solver/nodal.h"
#include "solver/observe.h"
#include "solver/stable_time_step.h"
#include "solver/step.h"
#include "transfer/gimp_cover.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace solver
{
namespace
{
/// Columns that only one formulation, transfer or law needs.
void add_scheme_columns(const Problem& problem, particles::Particles& particles)
{
    const Numerics& numerics = problem.numerics;
    const std::size_t count = particles.size();
    if (numerics.formulation == Formulation::total) {
        for (std::size_t n = 0; n < 9; ++n) particles.deformation_gradient[n].assign(count, n % 4 == 0 ? 1 : 0);
    } else {
        particles.volume_ratio.assign(count, 1);
    }
    if (numerics.transfer == Transfer::apic)
        for (particles::Column& entry : particles.affine) entry.assign(count, 0);
    const auto remembers = [](const material::Material& m) { return m.decohesion && m.decohesion->lode_memory > 0; };
    if (std::any_of(problem.materials.begin(), problem.materials.end(), remembers)) {
        particles.lode_mean.assign(count, 0);
        particles.lode_strain.assign(count, -1);
    }
}

/// Ids of the particles within `radius` of a point, or of the nearest one; sorted.
std::vector<std::uint32_t> particles_near(const particles::Particles& particles, const Vec3& point, Real radius)
{
    std::vector<std::uint32_t> ids;
    std::uint32_t nearest = 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 x(particles.rest_position[0][p], particles.rest_position[1][p], particles.rest_position[2][p]);
        const Real distance = (x - point).norm();
        if (distance < radius) ids.push_back(particles.id[p]);
        if (distance < least) {
            least = distance;
            nearest = particles.id[p];
        }
    }
    if (ids.empty()) ids.push_back(nearest);
    std::sort(ids.begin(), ids.end());
    return ids;
}

/// Particles of all bodies; the cells of the zones are returned.
grid::Refinement populate(const Problem& problem, const Prepared& prepared, State& state)
{
    const refine::Lattice lattice = lattice_of(problem.grid);
    if (problem.bodies.size() > 256 || problem.materials.size() > 256)
        throw core::InputError(fmt::format("{} bodies of {} materials are more than a particle can name (256 each)",
                                           problem.bodies.size(), problem.materials.size()));
    grid::Refinement refinement = refine::refinement_of(problem.zones, lattice, problem.bounds());
    for (const Body& body : problem.bodies) {
        const std::size_t before = state.particles.size();
        const material::Material& material = problem.materials[static_cast<std::size_t>(body.material)];
        refine::populate(body.shape,
                         {material.elastic.density, body.velocity, static_cast<std::uint8_t>(body.material),
                          problem.grid.edge, static_cast<std::uint8_t>(&body - problem.bodies.data())},
                         lattice, refinement, prepared.per_axis, state.particles);
        if (state.particles.size() == before)
            throw core::InputError(fmt::format("body '{}' has no particle: it is thinner than a cell of {} mm, or its "
                                               "shape is empty",
                                               body.name, problem.grid.cell));
    }
    add_scheme_columns(problem, state.particles);
    return refinement;
}

/// Initial motions, and cells that fit the particles where these put them.
void place_particles(const Problem& problem, const Prepared& prepared, State& state, grid::Refinement& refinement)
{
    set_initial_state(problem, state.particles);
    if (problem.numerics.formulation == Formulation::total) return;
    refinement = refine::refinement_from_targets(state.levels, state.particles);
    fit_cells(prepared, refinement, state);
    set_initial_state(problem, state.particles);
}

bool has_mass(const grid::Levels& levels, const grid::NodeAddress& at)
{
    return levels.sums(static_cast<std::size_t>(at.leaf))[at.node].mass > 0;
}

/// Nodes of a symmetry plane stay in it, whatever a load prescribes.
void check_planes(const Problem& problem, std::size_t load, const LoadNodes& nodes, const grid::Levels& levels)
{
    for (const SymmetryPlane& plane : problem.symmetry) {
        const std::optional<Real>& speed = problem.loads[load].velocity[static_cast<std::size_t>(plane.axis)];
        if (speed.value_or(0) == 0) continue;
        const Real slack = 1e-6 * levels.spacing(levels.count - 1);
        for (std::size_t n = 0; n < nodes.position.size(); ++n)
            if (std::abs(nodes.position[n][plane.axis] - plane.at) < slack && has_mass(levels, nodes.node[n]))
                throw core::InputError(fmt::format(
                    "load '{0}' moves nodes of the symmetry plane {1} = {2} mm along {1}, out of the plane: "
                    "let its region end before the plane, or leave that component \"free\"",
                    problem.loads[load].name, "xyz"[plane.axis], plane.at));
    }
}

void check_loads(const Problem& problem, const grid::Levels& levels, const Derived& derived)
{
    for (std::size_t i = 0; i < problem.loads.size(); ++i) {
        bool holds = false;
        for (const grid::NodeAddress& at : derived.load_nodes[i].node) holds = holds || has_mass(levels, at);
        if (!holds)
            throw core::InputError(fmt::format("load '{}' holds no node with mass: its region misses the body or is "
                                               "smaller than a cell",
                                               problem.loads[i].name));
        check_planes(problem, i, derived.load_nodes[i], levels);
    }
}

void find_fast_nodes(const Problem& problem, const grid::Levels& levels, Derived& derived)
{
    if (!problem.numerics.subcycling) return;
    std::vector<grid::NodeAddress> held;
    for (const LoadNodes& load : derived.load_nodes) held.insert(held.end(), load.node.begin(), load.node.end());
    derived.fast_nodes = grid::find_fast_nodes(levels, held);
}

/// What the first step finds of initial motions: velocities half a step earlier.
void set_back(const Problem& problem, const Prepared& prepared, State& state)
{
    const Real dt = stable_time_step(problem, prepared, state);
    state.clock.dt = substeps(problem) * dt;
    if (nodal(problem)) return set_node_motion(problem, prepared, dt, state);
    set_back_velocities(problem, dt, state.particles);
    transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
}
} // namespace

State initialise(const Problem& problem, const Prepared& prepared, Derived& derived)
{
    State state;
    state.levels.spacing0 = problem.grid.cell;
    state.levels.origin = problem.grid.origin;
    state.levels.count = problem.grid.levels;
    state.loads.resize(problem.loads.size());
    state.ligaments.resize(problem.ligaments.size());
    grid::Refinement refinement = populate(problem, prepared, state);
    fit_cells(prepared, refinement, state);
    const bool moving = begins_with_motion(problem);
    if (moving) place_particles(problem, prepared, state, refinement);
    order_cells(problem, prepared, refinement, state);
    state.leaf_work.assign(state.levels.leaves.size(), {});
    if (problem.gauge) {
        const Real radius = state.levels.spacing(state.levels.count - 1);
        state.gauge_upper = particles_near(state.particles, problem.gauge->upper, radius);
        state.gauge_lower = particles_near(state.particles, problem.gauge->lower, radius);
    }
    derived.ligaments = ligament_map(problem);
    find_places(problem, prepared, state, derived);
    const auto scatter = [&] {
        transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
    };
    scatter();
    // A held node may get all of its mass from another leaf's particles, or from a finer level's.
    grid::assemble_sums(state.levels);
    grid::restrict_sums(state.levels);
    check_loads(problem, state.levels, derived);
    scatter();
    if (nodal(problem)) {
        start_nodal(prepared, state);
        keep_heavy_nodes(state.levels, derived.load_nodes);
        if (moving) set_node_motion(problem, prepared, 0, state);
    }
    const Ledger start = audit(prepared, state);
    state.initial_energy = start.kinetic + start.elastic - start.external; // gravity counts from the rest position
    state.gauge_start = gauge_opening(problem, state, derived);
    if (moving) set_back(problem, prepared, state);
    if (problem.numerics.damps_fast_motion_only()) grid::start_means(state.levels);
    find_fast_nodes(problem, state.levels, derived);
    return state;
}

void resume(const Problem& problem, const Prepared& prepared, State& state, Derived& derived)
{
    std::vector<grid::NodeForce> force = std::move(state.levels.force);
    std::vector<grid::NodeMotion> motion = std::move(state.levels.motion);
    grid::restore(state.levels);
    derived.ligaments = ligament_map(problem);
    find_places(problem, prepared, state, derived);
    if (nodal(problem)) {
        state.levels.force = std::move(force);
        state.levels.motion = std::move(motion);
        resume_nodal(prepared, state);
        keep_heavy_nodes(state.levels, derived.load_nodes);
        find_fast_nodes(problem, state.levels, derived);
    } else {
        transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
    }
}
} // namespace solver
