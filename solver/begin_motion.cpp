#include "solver/begin_motion.h"

#include "core/parallel.h"
#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/walls.h"
#include "particles/tensors.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>

namespace solver
{
namespace
{
const Motion* initial_of(const Problem& problem, std::size_t body)
{
    const std::optional<int> index = problem.bodies[body].initial;
    return index ? &problem.motions[static_cast<std::size_t>(*index)] : nullptr;
}

/// `visit(p, motion)` for the particles of bodies with an initial motion.
template <class Visit>
void for_moving(const Problem& problem, const particles::Particles& particles, const Visit& visit)
{
    core::parallel_for(particles.size(), [&](std::size_t p) {
        if (const Motion* motion = initial_of(problem, particles.body[p])) visit(p, *motion);
    });
}

void set_velocity(const Problem& problem, std::size_t p, const MotionState& now, particles::Particles& particles)
{
    for (std::size_t a = 0; a < 3; ++a) particles.velocity[a][p] = now.velocity[static_cast<int>(a)];
    if (particles.affine[0].empty()) return;
    const bool total = problem.numerics.formulation == Formulation::total;
    const Mat3 affine = total ? now.rate : Mat3(now.rate * now.deformation.inverse());
    for (std::size_t n = 0; n < 9; ++n)
        particles.affine[n][p] = affine(static_cast<int>(n / 3), static_cast<int>(n % 3));
}

const Motion* nearest_motion(const Problem& problem, const Vec3& point)
{
    std::size_t nearest = 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
        const Real distance = problem.bodies[b].shape.distance(point);
        if (distance >= least) continue;
        least = distance;
        nearest = b;
    }
    return initial_of(problem, nearest);
}
} // namespace

bool begins_with_motion(const Problem& problem)
{
    return std::any_of(problem.bodies.begin(), problem.bodies.end(),
                       [](const Body& body) { return body.initial.has_value(); });
}

void set_initial_state(const Problem& problem, particles::Particles& particles)
{
    for_moving(problem, particles, [&](std::size_t p, const Motion& motion) {
        const MotionState now = at(motion, rest_of(particles, p), 0);
        for (std::size_t a = 0; a < 3; ++a)
            particles.position[a][p] = particles.rest_position[a][p] + now.displacement[static_cast<int>(a)];
        for (std::size_t n = 0; n < 6; ++n) particles.stress[n][p] = now.stress.s[n];
        if (particles.volume_ratio.empty())
            for (std::size_t n = 0; n < 9; ++n)
                particles.deformation_gradient[n][p] =
                    now.deformation(static_cast<int>(n / 3), static_cast<int>(n % 3));
        else
            particles.volume_ratio[p] = now.deformation.determinant();
        set_velocity(problem, p, now, particles);
    });
}

void set_back_velocities(const Problem& problem, Real dt, particles::Particles& particles)
{
    for_moving(problem, particles, [&](std::size_t p, const Motion& motion) {
        set_velocity(problem, p, at(motion, rest_of(particles, p), -dt / 2), particles);
    });
}

void set_node_motion(const Problem& problem, const Prepared& prepared, Real dt, State& state)
{
    grid::Levels& levels = state.levels;
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const grid::Leaf& leaf = levels.leaves[n];
        grid::NodeMotion* tile = levels.motions(n);
        const Real step = dt * (problem.numerics.subcycling ? 1 << (levels.count - 1 - leaf.level) : 1);
        for (int place = 0; place < grid::leaf_cells; ++place) {
            const Index3 local(place >> 6, place >> 3 & 7, place & 7);
            const int node = grid::tile_index(local[0], local[1], local[2]);
            if (levels.forces(n)[node].mass() <= 0) continue;
            const Vec3 x = levels.origin + levels.spacing(leaf.level) * (leaf.origin + local).cast<Real>();
            const Motion* motion = nearest_motion(problem, x);
            if (motion == nullptr) continue;
            const Vec3 displacement = at(*motion, x, 0).displacement, velocity = at(*motion, x, -step / 2).velocity;
            for (std::size_t a = 0; a < 3; ++a) {
                tile[node].change[a] = displacement[static_cast<int>(a)];
                tile[node].velocity[a] = velocity[static_cast<int>(a)];
            }
        }
        grid::fix_walls(prepared.walls, leaf, tile,
                        [](grid::NodeMotion& m, std::size_t a) { m.velocity[a] = m.change[a] = 0; });
    });
    grid::prolong_motion(levels);
    grid::fill_motion_halos(levels);
}
} // namespace solver
