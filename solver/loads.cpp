#include "solver/loads.h"

#include "core/error.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

namespace solver
{
namespace
{
using grid::NodeAddress;

Vec3 quantised(const Problem& problem, const Vec3& displacement)
{
    if (problem.numerics.formulation == Formulation::total) return Vec3::Zero();
    const Real finest = problem.grid.cell / static_cast<Real>(1 << (problem.grid.levels - 1));
    const Real quantum = load_shift_quantum * finest;
    return (displacement / quantum).array().round().matrix() * quantum;
}

Vec3 prescribed(const Load& load, Real time)
{
    Vec3 v = Vec3::Zero();
    for (int a = 0; a < 3; ++a)
        v[a] = load.velocity[static_cast<std::size_t>(a)].value_or(0) * ramp_value(load.ramp, time);
    return v;
}

/// Where a pin's nodes are about its axis: at rest positions in the total formulation, turned by the pin's angle.
struct Turn
{
    Vec3 centre;
    Vec3 axis = Vec3::Zero();
    Real cosine = 1, sine = 0;

    Turn(const Problem& problem, const Load& load, const LoadState& state) : centre(load.centre)
    {
        axis[load.axis] = 1;
        if (problem.numerics.formulation == Formulation::updated) {
            centre += state.displacement;
        } else {
            cosine = std::cos(state.angle);
            sine = std::sin(state.angle);
        }
    }

    /// Arm of a node, normal to the axis.
    Vec3 arm(const Vec3& position) const
    {
        Vec3 r = position - centre;
        r -= r.dot(axis) * axis;
        return cosine * r + sine * axis.cross(r);
    }
};

Vec3 spin_velocity(const Load& load, Real spin, const Vec3& r)
{
    Vec3 axis = Vec3::Zero();
    axis[load.axis] = spin;
    return axis.cross(r);
}

/// Mass of a held node [g], wherever the scheme keeps it.
Real mass_at(const grid::Levels& levels, const NodeAddress& at)
{
    const auto leaf = static_cast<std::size_t>(at.leaf);
    return levels.sum.empty() ? levels.forces(leaf)[at.node].mass() : levels.sums(leaf)[at.node].mass;
}

/// Share of a node's mapped velocity that its particles carry on; the rest is what FLIP prescribed before.
Real mapped_share(const Prepared& prepared)
{
    return prepared.options.transfer == Transfer::flip ? prepared.options.pic_fraction : Real(1);
}

/// Velocity a held node would have now without its load and without damping. Nodal scheme: as the forces have left it;
/// with damping, `before`, its prescribed one, plus dt (f / m + g). Else what the transfer carries on, plus dt (f / m +
/// g): FLIP carries the prescribed velocity `before`, PIC and APIC the mapped one.
Vec3 free_velocity(const Problem& problem, const Prepared& prepared, const grid::Levels& levels, const NodeAddress& at,
                   const Vec3& before, Real dt)
{
    const auto leaf = static_cast<std::size_t>(at.leaf);
    if (prepared.options.transfer == Transfer::nodal) {
        const grid::NodeMotion& motion = levels.motions(leaf)[at.node];
        if (problem.numerics.damping == 0) return {motion.velocity[0], motion.velocity[1], motion.velocity[2]};
        const grid::NodeForce& node = levels.forces(leaf)[at.node];
        const Vec3 force(node.force[0], node.force[1], node.force[2]);
        return before + dt * (node.per_mass * force + problem.gravity);
    }
    const Real mapped = mapped_share(prepared);
    const grid::NodeSum& sum = levels.sums(leaf)[at.node];
    const Vec3 momentum(sum.momentum[0], sum.momentum[1], sum.momentum[2]);
    const Vec3 force(sum.force[0], sum.force[1], sum.force[2]);
    return (1 - mapped) * before + (mapped * momentum + dt * force) / sum.mass + dt * problem.gravity;
}

/// Spin that makes the impulses m (after + spin x r - v) of the held nodes have no moment about the pin's axis.
Real new_spin(const Problem& problem, const Prepared& prepared, const Load& load, const LoadState& state,
              const LoadNodes& nodes, Real time, Real dt, const grid::Levels& levels)
{
    Real angular_momentum = 0;
    Real inertia = 0;
    const Vec3 before = prescribed(load, time);
    const Vec3 after = prescribed(load, time + dt);
    const Turn turn(problem, load, state);
    for (std::size_t n = 0; n < nodes.node.size(); ++n) {
        const Real mass = mass_at(levels, nodes.node[n]);
        if (mass <= 0) continue;
        const Vec3 r = turn.arm(nodes.position[n]);
        const Vec3 v =
            free_velocity(problem, prepared, levels, nodes.node[n], before + spin_velocity(load, state.spin, r), dt);
        angular_momentum += mass * r.cross(v - after)[load.axis];
        inertia += mass * r.squaredNorm();
    }
    return inertia > 0 ? angular_momentum / inertia : Real(0);
}
} // namespace

bool holds(const Load& load, int axis)
{
    return load.velocity[static_cast<std::size_t>(axis)].has_value() ||
           (load.kind == Load::Kind::pin && axis != load.axis);
}

Real ramp_value(const Ramp& ramp, Real time)
{
    if (ramp.kind == Ramp::Kind::step || time >= ramp.time) return 1;
    if (time <= 0) return 0;
    const Real s = time / ramp.time;
    if (ramp.kind == Ramp::Kind::linear) return s;
    return s * s * s * (10 - 15 * s + 6 * s * s);
}

namespace
{
/// Fill LoadNodes::before.
void find_shared_nodes(const Problem& problem, std::vector<LoadNodes>& nodes)
{
    std::map<std::pair<std::int32_t, int>, std::uint8_t> held;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        std::uint8_t components = 0;
        for (int a = 0; a < 3; ++a)
            if (holds(problem.loads[i], a)) components = static_cast<std::uint8_t>(components | 1 << a);
        nodes[i].before.clear();
        for (const NodeAddress& at : nodes[i].node) {
            std::uint8_t& all = held[{at.leaf, at.node}];
            nodes[i].before.push_back(all);
            all = static_cast<std::uint8_t>(all | components);
        }
    }
}
} // namespace

void keep_heavy_nodes(const grid::Levels& levels, std::vector<LoadNodes>& nodes)
{
    for (LoadNodes& held : nodes) {
        LoadNodes heavy;
        heavy.shift = held.shift;
        for (std::size_t n = 0; n < held.node.size(); ++n) {
            if (!(mass_at(levels, held.node[n]) > 0)) continue;
            heavy.node.push_back(held.node[n]);
            heavy.position.push_back(held.position[n]);
            heavy.before.push_back(held.before[n]);
        }
        held = std::move(heavy);
    }
}

void find_load_nodes(const Problem& problem, const grid::Levels& levels, const std::vector<LoadState>& loads,
                     std::vector<LoadNodes>& nodes)
{
    nodes.assign(problem.loads.size(), {});
    for (std::size_t i = 0; i < problem.loads.size(); ++i) nodes[i].shift = quantised(problem, loads[i].displacement);
    for (std::size_t n = 0; n < levels.leaves.size(); ++n) {
        const grid::Leaf& leaf = levels.leaves[n];
        const Real spacing = levels.spacing(leaf.level);
        const Vec3 lower = levels.origin + spacing * leaf.origin.cast<Real>();
        const Vec3 centre = lower + Vec3::Constant(spacing * grid::leaf_side / 2);
        for (std::size_t i = 0; i < problem.loads.size(); ++i) {
            const geometry::Shape& region = problem.loads[i].region;
            if (region.distance(centre - nodes[i].shift) > spacing * grid::leaf_side) continue;
            for (int place = 0; place < grid::leaf_cells; ++place) {
                const Index3 local(place >> 6, place >> 3 & 7, place & 7);
                const int node = grid::tile_index(local[0], local[1], local[2]);
                if (levels.constrained[n * grid::tile_nodes + static_cast<std::size_t>(node)] != 0) continue;
                const Vec3 at = lower + spacing * local.cast<Real>();
                // A small tolerance keeps nodes exactly on the region's face in.
                if (region.distance(at - nodes[i].shift) > 1e-9 * spacing) continue;
                nodes[i].node.push_back({static_cast<std::int32_t>(n), node});
                nodes[i].position.push_back(at);
            }
        }
    }
    find_shared_nodes(problem, nodes);
}

bool load_nodes_outdated(const Problem& problem, const std::vector<LoadState>& loads,
                         const std::vector<LoadNodes>& nodes)
{
    if (nodes.size() != loads.size()) return true;
    for (std::size_t i = 0; i < loads.size(); ++i)
        if (quantised(problem, loads[i].displacement) != nodes[i].shift) return true;
    return false;
}

void apply_loads(const Problem& problem, const Prepared& prepared, const std::vector<LoadNodes>& nodes, Real time,
                 Real dt, grid::Levels& levels, std::vector<LoadState>& loads)
{
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const Load& load = problem.loads[i];
        LoadState& state = loads[i];
        const Vec3 before = prescribed(load, time);
        const Vec3 after = prescribed(load, time + dt);
        const Real spin_before = state.spin;
        if (load.kind == Load::Kind::pin)
            state.spin = new_spin(problem, prepared, load, state, nodes[i], time, dt, levels);
        const Turn turn(problem, load, state);
        const Real mapped = mapped_share(prepared);
        Vec3 impulse = Vec3::Zero();
        Real held_mass = 0;
        for (std::size_t n = 0; n < nodes[i].node.size(); ++n) {
            const NodeAddress at = nodes[i].node[n];
            const Real mass = mass_at(levels, at);
            if (mass <= 0) continue;
            held_mass += mass;
            grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
            Vec3 old = before;
            Vec3 fresh = after;
            if (load.kind == Load::Kind::pin) {
                const Vec3 r = turn.arm(nodes[i].position[n]);
                old += spin_velocity(load, spin_before, r);
                fresh += spin_velocity(load, state.spin, r);
            }
            const Vec3 given = mass * (fresh - free_velocity(problem, prepared, levels, at, old, dt));
            for (int a = 0; a < 3; ++a) {
                if (!holds(load, a)) continue;
                const auto axis = static_cast<std::size_t>(a);
                // An earlier load has left velocity and change: what this one gives is the difference.
                const bool again = (nodes[i].before[n] >> a & 1) != 0;
                impulse[a] += again ? mass * (mapped * (fresh[a] - motion.velocity[axis]) +
                                              (1 - mapped) * (fresh[a] - old[a] - motion.change[axis]))
                                    : given[a];
                if (prepared.options.transfer == Transfer::nodal)
                    motion.change[axis] += dt * (fresh[a] - motion.velocity[axis]); // the displacement
                else
                    motion.change[axis] = fresh[a] - old[a];
                motion.velocity[axis] = fresh[a];
            }
        }
        if (held_mass <= 0)
            throw core::NumericalError(
                fmt::format("load '{}' has lost the body at t = {:.6g} ms: no node with mass is left in "
                            "its region. In the updated formulation a region must reach into the "
                            "body by more than a cell.",
                            load.name, time));
        state.reaction = impulse / dt;
        state.impulse += impulse;
        state.impulse_time += dt;
        state.sample_impulse += impulse;
        state.sample_time += dt;
        state.external_work += impulse.dot(before + after) / 2;
        state.displacement += dt * after;
        state.angle += dt * state.spin;
    }
}

void hold_loads(const Problem& problem, const std::vector<LoadNodes>& nodes, grid::Levels& levels)
{
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const NodeAddress& at : nodes[i].node) {
            grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
            for (int a = 0; a < 3; ++a)
                if (holds(problem.loads[i], a))
                    motion.change[static_cast<std::size_t>(a)] = motion.velocity[static_cast<std::size_t>(a)];
        }
}
} // namespace solver
