// What the transfers conserve exactly (methods.md A.4, 2 to 7, 9 and 10), for random particles on every topology.
#include "tests/support/scene.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using support::Scene;
using support::vector_of;
using transfer::Formulation;
using transfer::Transfer;

namespace
{
constexpr Formulation formulations[] = {Formulation::updated, Formulation::total};
constexpr Transfer transfers[] = {Transfer::flip, Transfer::apic};

transfer::PassOptions options_of(Formulation formulation, Transfer transfer)
{
    transfer::PassOptions options;
    options.formulation = formulation;
    options.transfer = transfer;
    options.dt = 1e-7;
    return options;
}

/// `check(topology, scene)` for every topology, formulation and transfer, sums gathered from a random state.
template <class Check>
void for_each_random_scene(const Check& check)
{
    for (const support::Topology& topology : support::topologies())
        for (const Formulation formulation : formulations)
            for (const Transfer transfer : transfers) {
                Scene scene = support::scene_of(topology, options_of(formulation, transfer), {support::soft_elastic()},
                                                support::Layout::random);
                support::randomise_state(3, scene);
                support::gather_sums(scene);
                check(topology, scene);
            }
}

template <class Term>
auto over_nodes(const grid::Levels& levels, const Term& term)
{
    auto total = term(grid::NodeAddress{0, 0}, grid::NodeSum{}, Vec3(Vec3::Zero()));
    total = total - total;
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        total += term(at, levels.sums(static_cast<std::size_t>(at.leaf))[at.node], x);
    });
    return total;
}

template <class Term>
auto over_particles(const particles::Particles& particles, const Term& term)
{
    auto total = term(std::size_t(0));
    for (std::size_t p = 1; p < particles.size(); ++p) total += term(p);
    return total;
}

Vec3 axial(const Eigen::Matrix3d& m)
{
    return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
}

const grid::NodeMotion& motion_at(const grid::Levels& levels, const grid::NodeAddress& at)
{
    return levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
}

Real volume(const Scene& scene, std::size_t p)
{
    return scene.particles.rest_volume[p] *
           (scene.options.formulation == Formulation::total
                ? support::matrix_of(scene.particles.deformation_gradient, p).determinant()
                : scene.particles.volume_ratio[p]);
}

/// Give every particle the deformation gradient I + grad u of a random nodal displacement, so that F is compatible;
/// returns u per node in the motion tiles.
void deform(Scene& scene)
{
    support::Random random(11);
    support::prescribe_motion([&](const Vec3&) { return random.vector(-0.02, 0.02); }, scene.levels);
    Scene probe = scene; // the affine matrix of one step is grad u
    transfer::advance_and_scatter(probe.options, probe.laws, probe.strays, probe.particles, probe.levels,
                                  probe.leaf_work);
    for (std::size_t n = 0; n < 9; ++n)
        for (std::size_t p = 0; p < scene.particles.size(); ++p)
            scene.particles.deformation_gradient[n][p] += probe.particles.affine[n][p];
}
} // namespace

TEST(Conservation, nodes_have_the_mass_momentum_and_centre_of_the_particles)
{
    for_each_random_scene([](const support::Topology& topology, const Scene& scene) {
        const particles::Particles& particles = scene.particles;
        const Real mass = over_particles(particles, [&](std::size_t p) { return particles.mass[p]; });
        const Real node_mass =
            over_nodes(scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3&) { return s.mass; });
        EXPECT_NEAR(node_mass / mass, 1, 1e-13) << topology;

        const Vec3 momentum = over_particles(
            particles, [&](std::size_t p) -> Vec3 { return particles.mass[p] * vector_of(particles.velocity, p); });
        const Vec3 node_momentum = over_nodes(
            scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3&) { return vector_of(s.momentum); });
        EXPECT_LT((node_momentum - momentum).norm() / mass, 1e-13) << topology;

        const Vec3 moment = over_particles(
            particles, [&](std::size_t p) -> Vec3 { return particles.mass[p] * vector_of(particles.position, p); });
        const Vec3 node_moment = over_nodes(
            scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3& x) -> Vec3 { return s.mass * x; });
        EXPECT_LT((node_moment - moment).norm() / mass, 1e-13) << topology;
    });
}

TEST(Conservation, internal_forces_sum_to_nothing)
{
    for_each_random_scene([](const support::Topology& topology, const Scene& scene) {
        const Vec3 force = over_nodes(
            scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3&) { return vector_of(s.force); });
        const Real size = over_nodes(
            scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3&) { return vector_of(s.force).norm(); });
        EXPECT_GT(size, 1) << topology;
        EXPECT_LT(force.norm(), 1e-13 * size) << topology;
    });
}

// Updated: about the nodes. Total: about the nodes moved by a displacement whose gradient the particles carry,
// sum (X + u) x f = - sum V0 e : (P F^T), which vanishes because the Kirchhoff stress P F^T is symmetric. About the
// nodes at rest it does not vanish.
TEST(Conservation, internal_forces_exert_no_torque)
{
    for (const support::Topology& topology : support::topologies())
        for (const Formulation formulation : formulations) {
            Scene scene = support::scene_of(topology, options_of(formulation, Transfer::apic),
                                            {support::soft_elastic()}, support::Layout::random);
            support::randomise_state(5, scene);
            const bool total = formulation == Formulation::total;
            if (total) deform(scene);
            support::gather_sums(scene);
            Real size = 0;
            const Vec3 torque =
                over_nodes(scene.levels, [&](const grid::NodeAddress& at, const grid::NodeSum& s, Vec3 x) -> Vec3 {
                    if (total) x += vector_of(motion_at(scene.levels, at).velocity);
                    size += x.norm() * vector_of(s.force).norm();
                    return x.cross(vector_of(s.force));
                });
            EXPECT_LT(torque.norm(), 1e-13 * size) << topology;
        }
}

// A.4, 6: sum x_i x p_i = sum [x_p x m v + m e : (D C^T)] with D = diag(xi (1 - xi) h^2) of the leaf cell the particle
// is in; the restriction to masters changes nothing because P reproduces positions.
TEST(Conservation, nodes_have_the_angular_momentum_of_the_particles)
{
    for_each_random_scene([](const support::Topology& topology, const Scene& scene) {
        const particles::Particles& particles = scene.particles;
        const grid::Levels& levels = scene.levels;
        Vec3 expected = Vec3::Zero();
        for (std::size_t n = 0; n < levels.leaves.size(); ++n)
            for (std::uint32_t p = levels.cell_start[n * grid::leaf_cells];
                 p < levels.cell_start[(n + 1) * grid::leaf_cells]; ++p) {
                const Vec3 x = vector_of(particles.position, p);
                expected += particles.mass[p] * x.cross(vector_of(particles.velocity, p));
                if (scene.options.transfer == Transfer::flip) continue;
                const Real h = levels.spacing(levels.leaves[n].level);
                const Vec3 scaled = (x - levels.origin) / h;
                const Vec3 xi = scaled.array() - scaled.array().floor();
                const Eigen::Matrix3d d = (h * h * xi.array() * (1 - xi.array())).matrix().asDiagonal();
                expected += particles.mass[p] * axial(support::matrix_of(particles.affine, p) * d);
            }
        const Vec3 nodes = over_nodes(levels, [](const auto&, const grid::NodeSum& s, const Vec3& x) -> Vec3 {
            return x.cross(vector_of(s.momentum));
        });
        const Real mass = over_particles(particles, [&](std::size_t p) { return particles.mass[p]; });
        EXPECT_LT((nodes - expected).norm(), 1e-13 * mass) << topology;
    });
}

TEST(Conservation, a_step_changes_no_momentum_of_a_free_body)
{
    for_each_random_scene([](const support::Topology& topology, Scene& scene) {
        const particles::Particles& particles = scene.particles;
        const auto momentum = [&]() -> Vec3 {
            return over_particles(
                particles, [&](std::size_t p) -> Vec3 { return particles.mass[p] * vector_of(particles.velocity, p); });
        };
        const Real mass = over_particles(particles, [&](std::size_t p) { return particles.mass[p]; });
        const Vec3 before = momentum();
        for (const Real pic : {0.0, 0.5}) {
            scene.options.pic_fraction = pic;
            for (const transfer::StressUpdate update : {transfer::StressUpdate::usl, transfer::StressUpdate::musl}) {
                scene.options.stress_update = update;
                transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
                support::advance(1e-5, scene);
                EXPECT_LT((momentum() - before).norm(), 1e-13 * mass) << topology;
            }
        }
    });
}

// A.4, 9: sum f . v + sum V sigma : L = 0, with the dilatation (updated: and the pressure) averaged over cells. In the
// total formulation the particles of a cell share all dilatation since the beginning, so the particles get one
// pressure per cell, as they would have.
TEST(Conservation, nodal_power_is_stress_power)
{
    for (const support::Topology& topology : support::topologies())
        for (const Formulation formulation : formulations)
            for (const bool averaged : {false, true}) {
                material::Material material = support::soft_elastic();
                material.cell_averaged_dilatation = averaged;
                Scene scene = support::scene_of(topology, options_of(formulation, Transfer::apic), {material},
                                                support::Layout::random);
                support::randomise_state(5, scene);
                const bool total = formulation == Formulation::total;
                if (total) deform(scene);
                support::gather_sums(scene);
                support::Random random(13);
                support::prescribe_motion([&](const Vec3&) { return random.vector(-1, 1); }, scene.levels);
                const Real nodes = over_nodes(scene.levels, [&](const auto& at, const grid::NodeSum& s, const Vec3&) {
                    return vector_of(s.force).dot(vector_of(motion_at(scene.levels, at).velocity));
                });
                Scene after = scene;
                transfer::advance_and_scatter(after.options, after.laws, after.strays, after.particles, after.levels,
                                              after.leaf_work);
                Real power = 0, size = 0;
                for (std::size_t c = 0; c + 1 < scene.levels.cell_start.size(); ++c) {
                    Real cell_volume = 0, pressure = 0, dilatation = 0;
                    for (std::uint32_t p = scene.levels.cell_start[c]; p < scene.levels.cell_start[c + 1]; ++p) {
                        const Eigen::Matrix3d stress = support::stress_of(scene.particles, p);
                        Eigen::Matrix3d l = support::matrix_of(after.particles.affine, p);
                        if (total) l *= support::matrix_of(scene.particles.deformation_gradient, p).inverse();
                        const Real v = volume(scene, p);
                        cell_volume += v;
                        pressure += v * stress.trace() / 3;
                        dilatation += v * l.trace();
                        power += v * (stress.cwiseProduct(l).sum() - stress.trace() * l.trace() / 3);
                        if (!averaged || total) power += v * stress.trace() * l.trace() / 3;
                        size += v * std::abs(stress.cwiseProduct(l).sum());
                    }
                    if (averaged && !total && cell_volume > 0) power += pressure * dilatation / cell_volume;
                }
                EXPECT_NEAR(nodes + power, 0, 1e-13 * size) << topology << ", averaged " << averaged;
            }
}

namespace
{
/// Largest force on a node inside the block under the uniform stress diag(1, 2, 3), over stress x finest spacing^2.
Real patch_force(const support::Topology& topology, const Vec3& moved)
{
    Scene scene = support::scene_of(topology, options_of(Formulation::updated, Transfer::flip),
                                    {support::soft_elastic()}, support::Layout::regular);
    for (std::size_t a = 0; a < 3; ++a) {
        for (Real& x : scene.particles.position[a]) x += moved[static_cast<int>(a)];
        for (Real& s : scene.particles.stress[a]) s = static_cast<Real>(a + 1);
    }
    support::order(scene);
    support::gather_sums(scene);
    const Real finest = scene.levels.spacing(scene.levels.count - 1);
    Vec3 lower = Vec3::Constant(1e30), upper = Vec3::Constant(-1e30);
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        lower = lower.cwiseMin(vector_of(scene.particles.position, p));
        upper = upper.cwiseMax(vector_of(scene.particles.position, p));
    }
    Real largest = 0;
    support::for_each_free_node(scene.levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        const Real inside = std::min((x - lower).minCoeff(), (upper - x).minCoeff());
        if (inside < scene.levels.spacing0) return;
        const auto& sum = scene.levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
        largest = std::max(largest, vector_of(sum.force).norm());
    });
    return largest / (finest * finest);
}
} // namespace

// A.4, 10, for point particles: exact on the layout they are seeded in, also where levels meet.
TEST(Conservation, uniform_stress_leaves_no_force_on_inner_nodes)
{
    for (const support::Topology& topology : support::topologies())
        EXPECT_LT(patch_force(topology, Vec3::Zero()), 1e-13) << topology;
}

// The known price of point particles: once coarse particles have moved into fine cells the force is of the order of
// stress x area (cell-crossing error, methods.md B1). A basis with extended particles would pass here.
TEST(Conservation, point_particles_fail_the_patch_test_after_crossing_an_interface)
{
    EXPECT_GT(patch_force(support::topologies()[1], Vec3(-0.15, 0, 0)), 0.1);
}

// A step starts from the sums that advance_and_scatter leaves; after a restart it starts from those of `scatter`.
TEST(Conservation, fused_and_separate_scatter_leave_the_same_bits)
{
    for_each_random_scene([](const support::Topology& topology, Scene& scene) {
        for (std::size_t a = 0; a < 3; ++a)
            for (Real& v : scene.particles.velocity[a]) v *= 100; // some particles change cells
        transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
        for (int n = 0; n < 3; ++n) {
            support::advance(2e-5, scene);
            grid::Levels again = scene.levels;
            transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, again);
            for (std::size_t i = 0; i < again.sum.size(); ++i) {
                ASSERT_EQ(again.sum[i].mass, scene.levels.sum[i].mass) << topology;
                ASSERT_EQ(again.sum[i].momentum, scene.levels.sum[i].momentum) << topology;
                ASSERT_EQ(again.sum[i].force, scene.levels.sum[i].force) << topology;
            }
        }
    });
}
