// What the transfers conserve exactly (methods.md A.4, 2 to 7, 9 and 10), for random particles on every topology.
#include "tests/support/basis.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using support::all_weights;
using support::Scene;
using support::vector_of;
using transfer::Basis;
using transfer::Formulation;
using transfer::Transfer;

namespace
{
constexpr Transfer transfers[] = {Transfer::flip, Transfer::apic};

transfer::PassOptions options_of(Formulation formulation, Transfer transfer, Basis basis = Basis::trilinear)
{
    transfer::PassOptions options;
    options.basis = basis;
    options.formulation = formulation;
    options.transfer = transfer;
    options.dt = 1e-7;
    return options;
}

/// `check(topology, scene)` for every topology, formulation, basis and transfer, sums gathered from a random state;
/// updated: once with every particle at home and once with strays.
template <class Check>
void for_each_random_scene(const Check& check)
{
    for (const support::Topology& topology : support::topologies())
        for (const auto& [formulation, basis] : all_weights)
            for (const Transfer transfer : transfers)
                for (const bool disturbed : {false, true}) {
                    if (disturbed && formulation == Formulation::total) continue;
                    Scene scene = support::scene_of(topology, options_of(formulation, transfer, basis),
                                                    {support::soft_elastic()}, support::Layout::random);
                    support::randomise_state(3, scene);
                    if (disturbed) {
                        support::disturb(4, scene);
                        ASSERT_GT(scene.strays.size(), 50U) << topology;
                    }
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
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        const Eigen::Matrix3d gradient = support::velocity_gradient(scene, p);
        for (std::size_t n = 0; n < 9; ++n)
            scene.particles.deformation_gradient[n][p] += gradient(static_cast<int>(n / 3), static_cast<int>(n % 3));
    }
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
        for (const auto& [formulation, basis] : all_weights) {
            Scene scene = support::scene_of(topology, options_of(formulation, Transfer::apic, basis),
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

namespace
{
/// D_p of every particle by id; zero for FLIP, whose particles carry no affine velocity.
std::vector<Eigen::Matrix3d> inertia_by_id(const Scene& scene)
{
    std::vector<Eigen::Matrix3d> inertia(scene.particles.size(), Eigen::Matrix3d::Zero());
    if (scene.options.transfer == Transfer::apic)
        for (std::size_t p = 0; p < inertia.size(); ++p)
            inertia[scene.particles.id[p]] = support::affine_inertia(scene, p);
    return inertia;
}

struct AngularMomentum
{
    Vec3 total = Vec3::Zero(); // sum m [x x v + e : (D C^T)], about the places where weights are taken
    Real size = 0;             // sum m |x| |v|
};

AngularMomentum angular_momentum(const Scene& scene, const std::vector<Eigen::Matrix3d>& inertia)
{
    AngularMomentum l;
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        const Vec3 x = support::weight_position(scene, p), v = vector_of(scene.particles.velocity, p);
        const Real m = scene.particles.mass[p];
        l.total += m * x.cross(v);
        if (scene.options.transfer == Transfer::apic)
            l.total += m * axial(support::matrix_of(scene.particles.affine, p) * inertia[scene.particles.id[p]]);
        l.size += m * x.norm() * v.norm();
    }
    return l;
}
} // namespace

// A.4, 6: sum x_a x p_a = sum [x_p x m v + m e : (D C^T)] with D about the free nodes, that is the masters.
TEST(Conservation, nodes_have_the_angular_momentum_of_the_particles)
{
    for_each_random_scene([](const support::Topology& topology, const Scene& scene) {
        const AngularMomentum expected = angular_momentum(scene, inertia_by_id(scene));
        const Vec3 nodes = over_nodes(scene.levels, [](const auto&, const grid::NodeSum& s, const Vec3& x) -> Vec3 {
            return x.cross(vector_of(s.momentum));
        });
        EXPECT_LT((nodes - expected.total).norm(), 1e-13 * expected.size) << topology;
    });
}

// A.4, 7: particles -> grid -> particles with internal forces. D is that of the positions the step began with: C is
// what the step carries on, and at the next positions D is another one (docs/theory.md).
TEST(Conservation, an_apic_step_changes_no_angular_momentum_of_a_free_body)
{
    for_each_random_scene([](const support::Topology& topology, const Scene& scene) {
        if (scene.options.transfer == Transfer::flip) return;
        const std::vector<Eigen::Matrix3d> inertia = inertia_by_id(scene);
        const AngularMomentum before = angular_momentum(scene, inertia);
        for (const transfer::StressUpdate update : {transfer::StressUpdate::usl, transfer::StressUpdate::musl}) {
            Scene after = scene;
            after.options.stress_update = update;
            transfer::scatter(after.options, after.laws, after.strays, after.particles, after.levels);
            support::advance(1e-5, after);
            EXPECT_LT((angular_momentum(after, inertia).total - before.total).norm(), 1e-13 * before.size) << topology;
        }
    });
}

// What all this is for: a free elastic block that turns goes on turning. With the positions of the slaves instead of
// the masters it lost a third of its angular momentum in these 150 steps; what is left comes from D (updated) and from
// deformation that is not linear in a cell (total), and one level has it too.
TEST(Conservation, a_turning_body_goes_on_turning_across_levels)
{
    const Vec3 spin(3, -5, 10); // rad/ms
    for (const support::Topology& topology : support::topologies())
        for (const auto& [formulation, basis] : all_weights) {
            transfer::PassOptions options = options_of(formulation, Transfer::apic, basis);
            if (formulation == Formulation::updated) options.stress_update = transfer::StressUpdate::musl;
            Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::regular);
            for (std::size_t p = 0; p < scene.particles.size(); ++p)
                for (int a = 0; a < 3; ++a) {
                    const Vec3 arm = vector_of(scene.particles.position, p) - scene.levels.origin;
                    scene.particles.velocity[static_cast<std::size_t>(a)][p] = spin.cross(arm)[a];
                    for (int b = 0; b < 3; ++b)
                        scene.particles.affine[static_cast<std::size_t>(3 * a + b)][p] = spin.cross(Vec3::Unit(b))[a];
                }
            transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
            const auto angular = [&]() -> Vec3 {
                return over_particles(scene.particles, [&](std::size_t p) -> Vec3 {
                    const Vec3 arm = vector_of(scene.particles.position, p) - scene.levels.origin;
                    return scene.particles.mass[p] * arm.cross(vector_of(scene.particles.velocity, p));
                });
            };
            const Vec3 before = angular();
            for (int n = 0; n < 150; ++n) support::advance(3e-5, scene);
            EXPECT_LT((angular() - before).norm(), 1e-4 * before.norm()) << topology;
        }
}

// In the total formulation D stays; without stress (and so without the torque of P about rest positions) many steps
// keep the angular momentum about rest positions.
TEST(Conservation, apic_keeps_the_angular_momentum_of_free_flight_about_rest_positions)
{
    material::Material dust = support::soft_elastic();
    dust.elastic.youngs_modulus = 1e-30;
    for (const support::Topology& topology : support::topologies())
        for (const transfer::StressUpdate update : {transfer::StressUpdate::usl, transfer::StressUpdate::musl}) {
            transfer::PassOptions options = options_of(Formulation::total, Transfer::apic);
            options.stress_update = update;
            Scene scene = support::scene_of(topology, options, {dust}, support::Layout::random);
            support::randomise_state(3, scene);
            for (particles::Column& component : scene.particles.stress)
                std::fill(component.begin(), component.end(), Real(0));
            transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
            const std::vector<Eigen::Matrix3d> inertia = inertia_by_id(scene);
            const AngularMomentum before = angular_momentum(scene, inertia);
            for (int n = 0; n < 20; ++n) support::advance(1e-3, scene);
            EXPECT_LT((angular_momentum(scene, inertia).total - before.total).norm(), 1e-12 * before.size) << topology;
        }
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
        // Strays leave corners of the block with almost no mass; a long step throws those nodes far.
        const Real dt = scene.strays.size() == 0 ? 1e-5 : 1e-7;
        for (const Real pic : {0.0, 0.5}) {
            scene.options.pic_fraction = pic;
            for (const transfer::StressUpdate update : {transfer::StressUpdate::usl, transfer::StressUpdate::musl}) {
                scene.options.stress_update = update;
                transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
                support::advance(dt, scene);
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
        for (const auto& [formulation, basis] : all_weights)
            for (const bool averaged : {false, true}) {
                material::Material material = support::soft_elastic();
                material.cell_averaged_dilatation = averaged;
                Scene scene = support::scene_of(topology, options_of(formulation, Transfer::apic, basis), {material},
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
                Real power = 0, size = 0;
                for (std::size_t c = 0; c + 1 < scene.levels.cell_start.size(); ++c) {
                    Real cell_volume = 0, pressure = 0, dilatation = 0;
                    for (std::uint32_t p = scene.levels.cell_start[c]; p < scene.levels.cell_start[c + 1]; ++p) {
                        const Eigen::Matrix3d stress = support::stress_of(scene.particles, p);
                        Eigen::Matrix3d l = support::velocity_gradient(scene, p);
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
Real patch_force(const support::Topology& topology, Basis basis, const Vec3& moved)
{
    Scene scene = support::scene_of(topology, options_of(Formulation::updated, Transfer::flip, basis),
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
        EXPECT_LT(patch_force(topology, Basis::trilinear, Vec3::Zero()), 1e-13) << topology;
}

// A.4, 10: boxes that tile the body leave no force, wherever the tiling has moved; cells and levels cut them anyhow.
TEST(Conservation, boxes_under_uniform_stress_leave_no_force_on_inner_nodes_after_any_shift)
{
    support::Random random(51);
    for (const support::Topology& topology : support::topologies()) {
        EXPECT_LT(patch_force(topology, Basis::gimp, Vec3::Zero()), 1e-13) << topology;
        for (int n = 0; n < 8; ++n)
            EXPECT_LT(patch_force(topology, Basis::gimp, random.vector(-0.3, 0.3)), 1e-13) << topology;
    }
}

// The known price of point particles: once coarse particles have moved into fine cells the force is of the order of
// stress x area (cell-crossing error, methods.md B1).
TEST(Conservation, point_particles_fail_the_patch_test_after_crossing_an_interface)
{
    EXPECT_GT(patch_force(support::topologies()[1], Basis::trilinear, Vec3(-0.15, 0, 0)), 0.1);
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
            for (grid::LevelInterface& face : again.interface)
                for (grid::CornerAffine& sum : face.hanging.affine) sum.entry[0].fill(1e30);
            transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, again);
            for (std::size_t i = 0; i < again.sum.size(); ++i) {
                ASSERT_EQ(again.sum[i].mass, scene.levels.sum[i].mass) << topology;
                ASSERT_EQ(again.sum[i].momentum, scene.levels.sum[i].momentum) << topology;
                ASSERT_EQ(again.sum[i].force, scene.levels.sum[i].force) << topology;
            }
            for (std::size_t l = 0; l < again.interface.size(); ++l) {
                const auto &fresh = again.interface[l].hanging.affine, &kept = scene.levels.interface[l].hanging.affine;
                ASSERT_EQ(kept.size(), fresh.size()) << topology;
                for (std::size_t c = 0; c < fresh.size(); ++c) ASSERT_EQ(fresh[c].entry, kept[c].entry) << topology;
            }
        }
    });
}
