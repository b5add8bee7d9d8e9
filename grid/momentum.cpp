#include "grid/momentum.h"

#include "core/parallel.h"
#include "grid/walls.h"

namespace grid
{
void advance_momentum(const std::vector<WallPlane>& walls, const Vec3& gravity, const std::vector<Real>& mass_cutoff,
                      Real dt, Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const Leaf& leaf = levels.leaves[n];
        const Real cutoff = mass_cutoff[static_cast<std::size_t>(leaf.level)];
        const NodeSum* sum = levels.sums(n);
        NodeMotion* motion = levels.motions(n);
        for_nodes(levels.used[n], leaf_side - 1, [&](int i) {
            const NodeSum& s = sum[i];
            NodeMotion& m = motion[i];
            const Real per_mass = s.mass > cutoff ? Real(1) / s.mass : Real(0);
            const Real moves = s.mass > cutoff ? dt : Real(0);
            for (std::size_t a = 0; a < 3; ++a) {
                const Real before = s.momentum[a] * per_mass;
                m.change[a] = moves * (s.force[a] * per_mass + gravity[static_cast<int>(a)]);
                m.velocity[a] = before + m.change[a];
            }
        });
        fix_walls(walls, leaf, motion, [](NodeMotion& m, std::size_t a) { m.velocity[a] = m.change[a] = 0; });
    });
}

void remap_velocity(const std::vector<WallPlane>& walls, const std::vector<Real>& mass_cutoff, Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const Leaf& leaf = levels.leaves[n];
        const Real cutoff = mass_cutoff[static_cast<std::size_t>(leaf.level)];
        const NodeSum* sum = levels.sums(n);
        NodeMotion* motion = levels.motions(n);
        for_nodes(levels.used[n], leaf_side - 1, [&](int i) {
            const Real per_mass = sum[i].mass > cutoff ? Real(1) / sum[i].mass : Real(0);
            for (std::size_t a = 0; a < 3; ++a) motion[i].change[a] = sum[i].momentum[a] * per_mass;
        });
        fix_walls(walls, leaf, motion, [](NodeMotion& m, std::size_t a) { m.change[a] = 0; });
    });
}
} // namespace grid
