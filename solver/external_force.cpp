#include "solver/external_force.h"

#include "core/parallel.h"
#include "grid/walls.h"
#include "solver/loads.h"
#include "solver/nodal.h"
#include "transfer/home_cells.h"

#include <algorithm>

namespace solver
{
namespace
{
Vec3 vector_at(const std::array<particles::Column, 3>& columns, std::size_t p)
{
    return {columns[0][p], columns[1][p], columns[2][p]};
}

void add_at(const transfer::CellFrame& frame, const Vec3& point, const Vec3& force, Vec3* tile)
{
    transfer::for_corners(frame, transfer::clamped_position(frame, point),
                          [&](int node, Real weight) { tile[node] += weight * force; });
}

bool has_body_force(const Problem& problem)
{
    return std::any_of(problem.bodies.begin(), problem.bodies.end(),
                       [](const Body& body) { return body.body_force.has_value(); });
}

/// Body force and surface forces of every particle to the tiles of `derived.external`, which are zeroed first where
/// there is one.
void gather_forces(const Problem& problem, const State& state, Derived& derived)
{
    const particles::Particles& particles = state.particles;
    const bool total = problem.numerics.formulation == Formulation::total;
    const auto& position = total ? particles.rest_position : particles.position;
    const Real time = state.clock.time;
    std::vector<Real> ramp;
    for (const SurfaceLoad& load : problem.surface_loads) ramp.push_back(ramp_value(load.ramp, time));
    const SurfaceForces& surface = derived.surface;
    const bool pulled = has_body_force(problem);
    const auto idle = [&](std::uint32_t begin, std::uint32_t end) {
        return !pulled && surface.start[begin] == surface.start[end]; // one of the two there is
    };
    transfer::for_each_in_cell(
        state.strays, particles, state.levels, idle,
        [&](std::size_t leaf, const transfer::CellFrame& frame, std::size_t p) {
            const auto motion = problem.bodies[particles.body[p]].body_force;
            const bool pushed = !surface.start.empty() && surface.start[p] != surface.start[p + 1];
            if (!motion && !pushed) return;
            Vec3* tile = derived.external.data() + leaf * grid::tile_nodes;
            if (!derived.pushed[leaf]) std::fill_n(tile, grid::tile_nodes, Vec3::Zero());
            derived.pushed[leaf] = 1;
            const Vec3 x = vector_at(position, p);
            if (motion) {
                const Vec3 rest = vector_at(particles.rest_position, p);
                const Vec3 pull = at(problem.motions[static_cast<std::size_t>(*motion)], rest, time).body_force;
                add_at(frame, x, particles.mass[p] * pull, tile);
            }
            if (!pushed) return;
            for (std::uint32_t f = surface.start[p]; f < surface.start[p + 1]; ++f) {
                const FaceForce& face = surface.face[f];
                add_at(frame, x + face.offset, ramp[static_cast<std::size_t>(face.load)] * face.force, tile);
            }
        });
}
} // namespace

bool has_external_forces(const Problem& problem)
{
    return !problem.surface_loads.empty() || has_body_force(problem);
}

void add_external_forces(const Problem& problem, State& state, Derived& derived)
{
    if (!has_external_forces(problem)) return;
    const std::size_t leaves = state.levels.leaves.size();
    derived.external.resize(leaves * grid::tile_nodes);
    derived.pushed.assign(leaves, 0);
    gather_forces(problem, state, derived);
    const bool on_forces = nodal(problem);
    core::parallel_for(leaves, [&](std::size_t n) {
        if (!derived.pushed[n]) return;
        const Vec3* tile = derived.external.data() + n * grid::tile_nodes;
        grid::for_nodes(state.levels.used[n], grid::leaf_side, [&](int i) {
            auto& force = on_forces ? state.levels.forces(n)[i].force : state.levels.sums(n)[i].force;
            for (std::size_t a = 0; a < 3; ++a) force[a] += tile[i][static_cast<int>(a)];
        });
    });
}

void add_external_work(const Problem& problem, const Derived& derived, State& state)
{
    if (!has_external_forces(problem)) return;
    const bool twice = nodal(problem);
    const Real power = core::parallel_sum(state.levels.leaves.size(), [&](std::size_t n) {
        Real sum = 0;
        if (!derived.pushed[n]) return sum;
        const Vec3* tile = derived.external.data() + n * grid::tile_nodes;
        const grid::NodeMotion* motion = state.levels.motions(n);
        grid::for_nodes(state.levels.used[n], grid::leaf_side, [&](int i) {
            for (std::size_t a = 0; a < 3; ++a)
                sum += tile[i][static_cast<int>(a)] *
                       (twice ? motion[i].velocity[a] / 2 : motion[i].velocity[a] - motion[i].change[a] / 2);
        });
        return sum;
    });
    state.source_work += state.clock.dt * power;
}

Real surface_force(const Problem& problem, const Derived& derived, std::size_t load, int axis, Real time)
{
    return problem.symmetry_factor(axis) * ramp_value(problem.surface_loads[load].ramp, time) *
           derived.surface.total[load][axis];
}
} // namespace solver
