#include "grid/damping.h"

#include "core/parallel.h"
#include "core/simd.h"
#include "grid/walls.h"

namespace grid
{
namespace
{
using Line = core::Pack<Real, 4>; // x, y, z and a lane nobody reads

/// A node between the forces and the damping of a step.
struct Pushed
{
    Real mass;   // g
    Line after;  // mm/ms, v + d
    Line gained; // mm/ms, d
};

Pushed pushed(const Damping& damping, const NodeMotion& motion, const NodeForce& force)
{
    const Line fall(Line::Lanes{damping.dt * damping.gravity[0], damping.dt * damping.gravity[1],
                                damping.dt * damping.gravity[2], 0});
    return {force.mass(), Line::load(motion.velocity.data()),
            Line(damping.dt * force.per_mass) * Line::load(force.force.data()) + fall};
}

Pushed pushed(const Damping&, const NodeMotion& motion, const NodeSum& sum)
{
    return {sum.mass, Line::load(motion.velocity.data()), Line::load(motion.change.data())};
}

struct Damped
{
    Line relative; // mm/ms, w
    Line taken;    // mm/ms, v + d - v+
    Line energy;   // mJ
};

Damped damped(const Damping& damping, const Pushed& node, Line mean)
{
    const Line none(Real(0));
    const Line middle = node.after - Line(Real(0.5)) * node.gained;
    const Line share(1 / (1 + (damping.rate + 1 / damping.memory) * damping.dt / 2));
    const Line relative = core::select((node.after < none) | (node.after > none), share * (middle - mean), none);
    const Line taken = Line(damping.rate * damping.dt) * relative;
    return {relative, taken, Line(node.mass) * taken * (middle - Line(Real(0.5)) * taken)};
}

/// `kept`: what the scheme keeps of the nodes of a leaf; `mean`: null without a memory.
template <class Kept>
Real damp_leaf(const Damping& damping, Real change_per_velocity, const NodeBox& used, const Kept* kept,
               NodeMotion* motion, NodeMean* mean)
{
    Line energy(Real(0));
    for_nodes(used, leaf_side - 1, [&](int i) {
        // As in advance_nodes: rows are short pieces of a tile.
        __builtin_prefetch(motion + i + 2 * tile_side);
        __builtin_prefetch(kept + i + 2 * tile_side);
        if (mean) __builtin_prefetch(mean + i + 2 * tile_side);
        const Pushed node = pushed(damping, motion[i], kept[i]);
        if (!(node.mass > 0)) return;
        const Line before = mean ? Line::load(mean[i].velocity.data()) : Line(Real(0));
        const Damped now = damped(damping, node, before);
        (node.after - now.taken).store(motion[i].velocity.data());
        (Line::load(motion[i].change.data()) - Line(change_per_velocity) * now.taken).store(motion[i].change.data());
        if (mean) (before + Line(damping.dt / damping.memory) * now.relative).store(mean[i].velocity.data());
        energy += now.energy;
    });
    return energy[0] + energy[1] + energy[2];
}
} // namespace

void start_means(Levels& levels)
{
    levels.mean.resize(levels.motion.size());
    for (std::size_t n = 0; n < levels.mean.size(); ++n) levels.mean[n] = {levels.motion[n].velocity, 0};
}

Real damp_motion(const Damping& damping, Levels& levels)
{
    return core::parallel_sum(levels.leaves.size(), [&](std::size_t n) {
        NodeMean* mean = levels.mean.empty() ? nullptr : levels.means(n);
        NodeMotion* motion = levels.motions(n);
        return levels.sum.empty() ? damp_leaf(damping, damping.dt, levels.used[n], levels.forces(n), motion, mean)
                                  : damp_leaf(damping, Real(1), levels.used[n], levels.sums(n), motion, mean);
    });
}

std::array<Real, 3> damped_energy(const Damping& damping, const NodeAddress& at, const Levels& levels)
{
    const auto leaf = static_cast<std::size_t>(at.leaf);
    const NodeMotion& motion = levels.motions(leaf)[at.node];
    const Pushed node = levels.sum.empty() ? pushed(damping, motion, levels.forces(leaf)[at.node])
                                           : pushed(damping, motion, levels.sums(leaf)[at.node]);
    if (!(node.mass > 0)) return {};
    const Line mean = levels.mean.empty() ? Line(Real(0)) : Line::load(levels.means(leaf)[at.node].velocity.data());
    const Line energy = damped(damping, node, mean).energy;
    return {energy[0], energy[1], energy[2]};
}
} // namespace grid
