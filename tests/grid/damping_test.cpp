#include "grid/damping.h"

#include "grid/momentum.h"
#include "grid/nodal.h"
#include "tests/support/topologies.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
constexpr Real dt = 0.1;
constexpr std::array<Real, 3> before{1, 2, 3}, gained{1, -3, 4}; // mm/ms

/// Free nodes of 2 g with the velocity `before`, and forces that give them `gained` in a step; slaves have no mass.
grid::Levels pushed_nodes()
{
    grid::Levels levels = support::levels_of(support::topologies()[1]);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        grid::NodeSum& sum = levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
        sum.mass = 2;
        for (std::size_t a = 0; a < 3; ++a) {
            sum.momentum[a] = 2 * before[a];
            sum.force[a] = 2 * gained[a] / dt;
        }
    });
    return levels;
}

/// Damp, and see that the energy is what every node says it is.
void damp(const grid::Damping& damping, grid::Levels& levels)
{
    Real energy = 0;
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        for (const Real part : grid::damped_energy(damping, at, levels)) energy += part;
    });
    EXPECT_NEAR(grid::damp_motion(damping, levels) / energy, 1, 1e-12);
}
} // namespace

// w = (v + d / 2) / (1 + a dt / 2), v+ = v + d - a dt w.
TEST(GridDamping, is_implicit_in_the_mean_velocity_of_the_step)
{
    const Real rate = 4;
    grid::Levels levels = pushed_nodes();
    grid::advance_momentum({}, Vec3::Zero(), {0, 0}, dt, levels);
    damp({rate, std::numeric_limits<Real>::infinity(), dt, Vec3::Zero()}, levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
        for (std::size_t a = 0; a < 3; ++a) {
            const Real taken = rate * dt * (before[a] + gained[a] / 2) / (1 + rate * dt / 2);
            EXPECT_NEAR(motion.velocity[a], before[a] + gained[a] - taken, 1e-14);
            EXPECT_NEAR(motion.change[a], gained[a] - taken, 1e-14);
        }
    });
}

// u = v at the start, so w = (d / 2) / (1 + (a + 1 / T) dt / 2), and u+ = u + dt w / T.
TEST(GridDamping, with_a_memory_is_of_what_the_mean_has_not)
{
    const Real rate = 4, memory = 0.5;
    grid::Levels levels = pushed_nodes();
    grid::start_nodes({}, {0, 0}, levels);
    grid::start_means(levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        for (std::size_t a = 0; a < 3; ++a)
            levels.forces(static_cast<std::size_t>(at.leaf))[at.node].force[a] = 2 * gained[a] / dt;
    });
    grid::advance_nodes({}, Vec3::Zero(), {dt}, levels);
    damp({rate, memory, dt, Vec3::Zero()}, levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        for (std::size_t a = 0; a < 3; ++a) {
            const Real relative = gained[a] / 2 / (1 + (rate + 1 / memory) * dt / 2);
            const Real velocity = before[a] + gained[a] - rate * dt * relative;
            EXPECT_NEAR(levels.motions(leaf)[at.node].velocity[a], velocity, 1e-12);
            EXPECT_NEAR(levels.motions(leaf)[at.node].change[a], dt * velocity, 1e-12); // the displacement
            EXPECT_NEAR(levels.means(leaf)[at.node].velocity[a], before[a] + dt * relative / memory, 1e-12);
        }
    });
}

TEST(GridDamping, leaves_walls_where_they_are)
{
    const std::vector<grid::WallPlane> walls{{0, 0}};
    grid::Levels levels = pushed_nodes();
    grid::start_nodes(walls, {0, 0}, levels);
    grid::advance_nodes(walls, Vec3(3, 0, 0), {dt}, levels);
    damp({4, std::numeric_limits<Real>::infinity(), dt, Vec3(3, 0, 0)}, levels);
    int on_plane = 0;
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        if (std::abs(x[0] - levels.origin[0]) > 1e-9) return;
        ++on_plane;
        EXPECT_EQ(levels.motions(static_cast<std::size_t>(at.leaf))[at.node].velocity[0], 0);
        EXPECT_EQ(levels.motions(static_cast<std::size_t>(at.leaf))[at.node].change[0], 0);
    });
    EXPECT_GT(on_plane, 0);
}
