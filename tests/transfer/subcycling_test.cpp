/// Sub-cycling across levels (methods.md A.7): against the page of tests/support/dense_nodal.h, what it conserves, and
/// when it is stable.
#include "material/elastic.h"
#include "tests/support/lattice_run.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using support::DenseNodal;
using support::LatticeRun;
using support::Scene;
using transfer::Precision;

namespace
{
constexpr Real dt = 1e-5; // ms, of the finest level; its cells allow 5e-5

std::vector<material::Material> breaking_metals()
{
    std::vector<material::Material> metals = support::two_metals(10, true);
    material::Decohesion law;
    law.s_max = 9;
    law.tau_max = 5.2;
    law.u0 = 3e-4;
    law.friction = 0.3;
    metals[0].decohesion = law;
    return metals;
}

/// Largest difference of displacement (per spacing), velocity and stress (each over its largest entry).
Real difference(const LatticeRun& run, const DenseNodal& dense)
{
    const particles::Particles particles = support::filled(run);
    Real apart[3] = {}, fastest = 0, strongest = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const support::NodalPoint& point = dense.points[p];
        const Vec3 u = support::vector_of(particles.position, p) - point.rest_position;
        apart[0] = std::max(apart[0], (u - dense.displacement(p)).norm() / run.scene.levels.spacing0);
        for (std::size_t n = 0; n < 6; ++n) {
            apart[2] = std::max(apart[2], std::abs(particles.stress[n][p] - point.stress.s[n]));
            strongest = std::max(strongest, std::abs(point.stress.s[n]));
        }
    }
    support::for_each_free_node(run.scene.levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        if (run.scene.levels.forces(leaf)[at.node].per_mass == 0) return;
        const Vec3 place = (x - dense.origin) / run.scene.levels.spacing(dense.levels - 1);
        const DenseNodal::NodeState& node =
            dense.nodes.at({int(std::lround(place[0])), int(std::lround(place[1])), int(std::lround(place[2]))});
        const Vec3 v = support::vector_of(run.scene.levels.motions(leaf)[at.node].velocity);
        apart[1] = std::max(apart[1], (v - node.velocity).norm());
        fastest = std::max(fastest, node.velocity.norm());
    });
    return std::max({apart[0], apart[1] / fastest, apart[2] / strongest});
}

/// Momentum and angular momentum about the origin of the free nodes, and what they would be if nothing cancelled.
struct Motion
{
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
    Real size = 0, angular_size = 0, kinetic = 0;
};

Motion motion_of(const LatticeRun& run)
{
    Motion sum;
    support::for_each_free_node(run.scene.levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        const grid::NodeMotion& motion = run.scene.levels.motions(leaf)[at.node];
        const Vec3 p = run.scene.levels.forces(leaf)[at.node].mass() * support::vector_of(motion.velocity);
        const Vec3 place = x + support::vector_of(motion.change);
        sum.momentum += p;
        sum.angular += place.cross(p);
        sum.size += p.norm();
        sum.angular_size += place.norm() * p.norm();
        sum.kinetic += p.dot(support::vector_of(motion.velocity)) / 2;
    });
    return sum;
}

Real elastic_energy(const LatticeRun& run)
{
    std::vector<transfer::LatticeSurvey> survey;
    transfer::survey_lattice(run.scene.laws, run.lattice, run.scene.particles, run.scene.levels, survey);
    Real energy = 0;
    for (const transfer::LatticeSurvey& leaf : survey) energy += leaf.elastic;
    return energy;
}

/// Elastic block of a topology with a random velocity, small enough to be linear.
Scene ringing(const support::Topology& topology)
{
    transfer::PassOptions options;
    options.transfer = transfer::Transfer::nodal;
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::regular);
    support::stir(5, 0, 1e-4, scene);
    return scene;
}

/// cfl h_f / c_d.
Real step_of(Real cfl, const Scene& scene)
{
    return cfl * scene.levels.spacing(scene.levels.count - 1) / scene.laws.constants[0].wave_speed;
}

class EverySubcycledTopology : public testing::TestWithParam<support::Topology>
{};
} // namespace

INSTANTIATE_TEST_SUITE_P(Subcycling, EverySubcycledTopology, testing::ValuesIn(support::topologies()));

TEST_P(EverySubcycledTopology, steps_of_a_plastic_cut_body_are_those_of_the_plain_scheme)
{
    const std::vector<grid::WallPlane> walls{{1, 1}};
    const Vec3 gravity(300, -500, 200);
    Scene scene = support::cut_scene(GetParam(), support::two_metals(10, true), 3);
    support::stir(4, 10, 30, scene);
    DenseNodal dense = support::dense_nodal(scene, walls, gravity);
    LatticeRun run = support::lattice_run(scene, Precision::f64, walls, gravity);
    for (int n = 0; n < 20; ++n) {
        support::advance_subcycled(dt, run);
        dense.nested_step(dt);
    }
    EXPECT_LT(difference(run, dense), 1e-11);
    EXPECT_GT(dense.plastic_work, 0);
    EXPECT_NEAR(run.plastic_work / dense.plastic_work, 1, 1e-11);
}

// Onset, softening, separation and friction, on both sides of interfaces.
TEST(Subcycling, a_breaking_body_is_that_of_the_plain_scheme)
{
    for (const std::size_t topology : {2U, 4U}) {
        Scene scene = support::cut_scene(support::topologies()[topology], breaking_metals(), 7);
        support::stir(8, 5, 60, scene);
        DenseNodal dense = support::dense_nodal(scene);
        LatticeRun run = support::lattice_run(scene, Precision::f64);
        for (int n = 0; n < (topology == 2 ? 60 : 30); ++n) {
            support::advance_subcycled(dt, run);
            dense.nested_step(dt);
        }
        const particles::Particles& particles = run.scene.particles;
        std::vector<int> cracks(static_cast<std::size_t>(dense.levels));
        for (std::size_t p = 0; p < particles.size(); ++p) {
            ASSERT_EQ(particles.crack[p] >= 0, dense.points[p].crack.has_value()) << "particle " << p;
            if (particles.crack[p] < 0) continue;
            const core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
            EXPECT_NEAR(crack.damage, dense.points[p].crack->damage, 1e-8);
            EXPECT_NEAR(crack.onset_time, dense.points[p].crack->onset_time, 1e-15);
            ++cracks[static_cast<std::size_t>(dense.points[p].level)];
        }
        for (const int count : cracks) EXPECT_GT(count, 10);
        EXPECT_LT(difference(run, dense), 1e-8);
        EXPECT_NEAR(run.decohesion_work / dense.decohesion_work, 1, 1e-9);
    }
}

// Every impulse sums to zero and has no torque about the present positions; both hold while the body yields and breaks.
TEST_P(EverySubcycledTopology, a_free_body_keeps_its_momentum_and_angular_momentum)
{
    Scene scene = support::cut_scene(GetParam(), breaking_metals(), 9);
    support::stir(10, 5, 60, scene);
    LatticeRun run = support::lattice_run(scene, Precision::f64);
    const Motion before = motion_of(run);
    for (int n = 0; n < 100; ++n) support::advance_subcycled(dt, run);
    const Motion after = motion_of(run);
    EXPECT_GT(run.scene.particles.cracks.size(), 100U);
    EXPECT_LT(std::abs(after.kinetic / before.kinetic), 0.9); // something has happened
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12 * before.size);
    EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * before.angular_size);
}

// methods.md B18 in three dimensions: random velocity feeds every mode; nothing may grow.
TEST_P(EverySubcycledTopology, energy_stays_bounded_up_to_the_largest_cfl)
{
    for (const Real cfl : {0.3, 0.6}) {
        Scene scene = ringing(GetParam());
        LatticeRun run = support::lattice_run(scene, Precision::f64);
        const Real step = step_of(cfl, scene), before = motion_of(run).kinetic;
        Real largest = 0, early = 0, late = 0;
        constexpr int count = 2000;
        for (int n = 0; n < count; ++n) {
            support::advance_subcycled(step, run);
            if (n % 10 != 0) continue;
            const Real energy = (motion_of(run).kinetic + elastic_energy(run)) / before;
            largest = std::max(largest, energy);
            (n < count / 2 ? early : late) += energy / (count / 20);
        }
        EXPECT_LT(largest, 1.5) << cfl;
        EXPECT_NEAR(late / early, 1, 0.01) << cfl;
    }
}

// The natural wrong way, slow forces held and given in parts with every fine step, is not stable at any step.
TEST(Subcycling, frozen_slow_forces_are_unstable)
{
    const support::Topology topology =
        support::topology_of("small flat face", 2, 1, [](const auto& key) { return key.cell[0] < 0; });
    for (const Real cfl : {0.3, 0.5}) {
        Real grown[2];
        for (const auto slow : {DenseNodal::Slow::impulse, DenseNodal::Slow::frozen}) {
            const Scene scene = ringing(topology);
            DenseNodal dense = support::dense_nodal(scene);
            const auto kinetic = [&] {
                Real sum = 0;
                for (const auto& [key, node] : dense.nodes) sum += node.mass * node.velocity.squaredNorm() / 2;
                return sum;
            };
            const Real before = kinetic();
            for (int n = 0; n < 200; ++n) dense.nested_step(step_of(cfl, scene), slow);
            grown[static_cast<int>(slow)] = kinetic() / before;
        }
        EXPECT_LT(grown[0], 1.5) << cfl;
        EXPECT_GT(grown[1], 10) << cfl;
    }
}
