#include "grid/nodal.h"

#include "core/huge_pages.h"
#include "core/parallel.h"
#include "core/simd.h"
#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/shared_nodes.h"

#include <algorithm>

namespace grid
{
namespace
{
/// Assembled and restricted masses into the force tiles.
void set_masses(const std::vector<Real>& mass_cutoff, Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const Real cutoff = mass_cutoff[static_cast<std::size_t>(levels.leaves[n].level)];
        for (int i = 0; i < tile_nodes; ++i) levels.forces(n)[i].per_mass = 0;
        for_owned_nodes([&](int i) {
            const Real mass = levels.sums(n)[i].mass;
            if (mass > cutoff) levels.forces(n)[i].per_mass = 1 / mass;
        });
    });
}

void assemble_masses(const std::vector<Real>& mass_cutoff, Levels& levels)
{
    assemble_sums(levels);
    restrict_sums(levels);
    set_masses(mass_cutoff, levels);
}

void add_lower_halos(std::size_t leaf, Levels& levels)
{
    NodeForce* own = levels.forces(leaf);
    for_lower_halos(levels, leaf, [&](std::size_t lower, int mine, int halo) {
        for (std::size_t a = 0; a < 3; ++a) own[mine].force[a] += levels.forces(lower)[halo].force[a];
    });
}

/// What the forces of slaves change in their masters' motion. `whole`: the masters' forces have them too then.
void push_masters(Real dt, bool whole, const LevelInterface& face, Levels& levels)
{
    core::parallel_for(face.master.size(), [&](std::size_t m) {
        const auto leaf = static_cast<std::size_t>(face.master[m].leaf);
        NodeMotion& motion = levels.motions(leaf)[face.master[m].node];
        NodeForce& master = levels.forces(leaf)[face.master[m].node];
        const Real impulse = dt * master.per_mass;
        for (std::int32_t e = face.column_start[m]; e < face.column_start[m + 1]; ++e) {
            const auto entry = static_cast<std::size_t>(e);
            const NodeAddress& at = face.slave[static_cast<std::size_t>(face.column_slave[entry])];
            const NodeForce& slave = levels.forces(static_cast<std::size_t>(at.leaf))[at.node];
            for (std::size_t a = 0; a < 3; ++a) {
                const Real force = face.column_weight[entry] * slave.force[a];
                motion.velocity[a] += impulse * force;
                motion.change[a] += dt * impulse * force;
                if (whole) master.force[a] += force;
            }
        }
    });
}
} // namespace

void start_nodes(const std::vector<WallPlane>& walls, const std::vector<Real>& mass_cutoff, Levels& levels)
{
    core::reserve_huge_pages(levels.sum.size(), levels.force);
    levels.force.resize(levels.sum.size());
    for (std::size_t n = 0; n < levels.sum.size(); ++n) levels.force[n] = {levels.sum[n].force, 0};
    assemble_masses(mass_cutoff, levels);
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        NodeMotion* motion = levels.motions(n);
        for_owned_nodes([&](int i) {
            const NodeSum& sum = levels.sums(n)[i];
            motion[i] = {};
            if (levels.forces(n)[i].per_mass == 0) return;
            for (std::size_t a = 0; a < 3; ++a) motion[i].velocity[a] = sum.momentum[a] / sum.mass;
        });
        fix_walls(walls, levels.leaves[n], motion, [](NodeMotion& m, std::size_t a) { m.velocity[a] = 0; });
    });
    std::vector<NodeSum>().swap(levels.sum);
}

void restore_masses(const std::vector<Real>& mass_cutoff, Levels& levels)
{
    assemble_masses(mass_cutoff, levels);
    std::vector<NodeSum>().swap(levels.sum);
}

void advance_nodes(const std::vector<WallPlane>& walls, const Vec3& gravity, const LevelSteps& steps, Levels& levels)
{
    using Line = core::Pack<Real, 4>;
    const Line axes(Line::Lanes{1, 1, 1, 0});
    const std::size_t first = levels.first_leaf(steps.first);
    core::parallel_for(levels.leaves.size() - first, [&](std::size_t task) {
        const std::size_t n = first + task;
        const Real dt = steps.of(levels.leaves[n].level);
        const Line falling(Line::Lanes{dt * gravity[0], dt * gravity[1], dt * gravity[2], 0});
        add_lower_halos(n, levels);
        const NodeForce* force = levels.forces(n);
        NodeMotion* motion = levels.motions(n);
        for_nodes(levels.used[n], leaf_side - 1, [&](int i) {
            // Rows are short pieces of a tile: what the hardware fetches ahead ends with each of them.
            __builtin_prefetch(motion + i + 2 * tile_side);
            __builtin_prefetch(force + i + 2 * tile_side);
            // Fourth lanes: the spare places, which nobody reads, and 1 / m.
            const Real impulse = dt * force[i].per_mass;
            const Line fall(impulse == 0 ? Line(Real(0)) : falling);
            const Line drift(impulse == 0 ? Real(0) : dt); // slaves keep where they were: prolong_displacement
            const Line velocity =
                Line::load(motion[i].velocity.data()) + Line(impulse) * Line::load(force[i].force.data()) * axes + fall;
            velocity.store(motion[i].velocity.data());
            (Line::load(motion[i].change.data()) + drift * velocity).store(motion[i].change.data());
        });
    });
    const int fine = std::max(1, steps.first); // finer side of the coarsest interface that is pushed
    for (int l = levels.count - 1; l >= fine; --l)
        push_masters(steps.of(l), !steps.doubled, levels.interface[static_cast<std::size_t>(l) - 1], levels);
    const std::size_t pushed = levels.first_leaf(fine - 1);
    core::parallel_for(levels.leaves.size() - pushed, [&](std::size_t task) {
        const std::size_t n = pushed + task;
        fix_walls(walls, levels.leaves[n], levels.motions(n),
                  [](NodeMotion& m, std::size_t a) { m.velocity[a] = m.change[a] = 0; });
    });
}
} // namespace grid
