#include "grid/fast_nodes.h"

#include "core/parallel.h"

#include <algorithm>
#include <tuple>

namespace grid
{
namespace
{
/// `visit(node, its motion)` for the nodes from a level on.
template <class Visit>
void for_fast_nodes(int first_level, Levels& levels, FastNodes& fast, const Visit& visit)
{
    for (auto level = static_cast<std::size_t>(first_level); level < fast.size(); ++level)
        core::parallel_for(fast[level].size(), [&](std::size_t n) {
            FastNode& node = fast[level][n];
            visit(node, levels.motions(static_cast<std::size_t>(node.at.leaf))[node.at.node]);
        });
}
} // namespace

FastNodes find_fast_nodes(const Levels& levels, const std::vector<NodeAddress>& held)
{
    std::vector<NodeAddress> all = held;
    for (const LevelInterface& face : levels.interface) all.insert(all.end(), face.master.begin(), face.master.end());
    const auto key = [](const NodeAddress& at) { return std::tuple(at.leaf, at.node); };
    std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    all.erase(std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
              all.end());
    FastNodes fast(static_cast<std::size_t>(levels.count - 1));
    for (const NodeAddress& at : all) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        const int level = levels.leaves[leaf].level;
        if (level + 1 == levels.count || levels.forces(leaf)[at.node].per_mass == 0) continue;
        const NodeMotion& motion = levels.motions(leaf)[at.node];
        fast[static_cast<std::size_t>(level)].push_back({at, motion.change, motion.change, {}});
    }
    return fast;
}

void drift_fast_nodes(Real dt, Levels& levels, FastNodes& fast)
{
    for_fast_nodes(0, levels, fast, [&](FastNode& node, NodeMotion& motion) {
        for (std::size_t a = 0; a < 3; ++a) motion.change[a] = node.now[a] += dt * motion.velocity[a];
    });
}

void average_fast_nodes(const LevelSteps& steps, Levels& levels, FastNodes& fast)
{
    for_fast_nodes(steps.first, levels, fast, [&](FastNode& node, NodeMotion& motion) {
        const Real per_dt = 1 / steps.of(levels.leaves[static_cast<std::size_t>(node.at.leaf)].level);
        node.velocity = motion.velocity;
        for (std::size_t a = 0; a < 3; ++a) motion.velocity[a] = per_dt * (node.now[a] - node.begin[a]);
    });
}

void release_fast_nodes(const LevelSteps& steps, Levels& levels, FastNodes& fast)
{
    for_fast_nodes(steps.first, levels, fast, [&](FastNode& node, NodeMotion& motion) {
        motion.velocity = node.velocity;
        node.begin = node.now;
    });
}
} // namespace grid
