// Partition of unity, linear completeness and gradient completeness (methods.md A.4, 1 and 11), through the passes a
// step uses: nodal fields that are constant or linear must arrive unchanged on every particle.
#include "tests/support/scene.h"

#include <gtest/gtest.h>

using support::all_weights;
using support::Scene;
using transfer::Basis;
using transfer::Formulation;
using transfer::StressUpdate;
using transfer::Transfer;

namespace
{
const Eigen::Matrix3d gradient = (Eigen::Matrix3d() << 0.3, -1.1, 0.7, 2.0, -0.4, 0.9, -0.6, 1.3, 0.5).finished();
const Vec3 shift(0.4, -2.5, 1.7);

transfer::PassOptions affine_options(const support::Weights& weights)
{
    transfer::PassOptions options;
    options.formulation = weights.formulation;
    options.basis = weights.basis;
    options.transfer = Transfer::apic;
    options.dt = 1e-9;
    return options;
}

/// Random particles after one step in the nodal field G x + w.
Scene moved(const support::Topology& topology, const transfer::PassOptions& options, const Eigen::Matrix3d& g)
{
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
    support::prescribe_motion([&](const Vec3& x) -> Vec3 { return g * x + shift; }, scene.levels);
    transfer::advance_and_scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels,
                                  scene.leaf_work);
    return scene;
}
} // namespace

TEST(Completeness, a_constant_field_is_carried_exactly_and_strains_nothing)
{
    for (const support::Topology& topology : support::topologies())
        for (const support::Weights& weights : all_weights) {
            const Scene scene = moved(topology, affine_options(weights), Eigen::Matrix3d::Zero());
            for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                ASSERT_LT((support::vector_of(scene.particles.velocity, p) - shift).norm(), 1e-14) << topology;
                // Differences of equal velocities vanish exactly; boxes sum up slopes, to round-off.
                const bool boxes = weights.basis == Basis::gimp;
                ASSERT_LE(support::matrix_of(scene.particles.affine, p).norm(), boxes ? 2e-13 : 0) << topology;
                ASSERT_LE(support::stress_of(scene.particles, p).norm(), boxes ? 1e-18 : 0) << topology;
            }
        }
}

TEST(Completeness, a_linear_field_has_its_value_and_gradient_on_every_particle)
{
    for (const support::Topology& topology : support::topologies())
        for (const support::Weights& weights : all_weights) {
            const Scene scene = moved(topology, affine_options(weights), gradient);
            for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                const Vec3 x = support::vector_of(scene.particles.rest_position, p);
                ASSERT_LT((support::vector_of(scene.particles.velocity, p) - gradient * x - shift).norm(), 1e-13)
                    << topology;
                ASSERT_LT((support::matrix_of(scene.particles.affine, p) - gradient).norm(), 2e-12) << topology;
            }
        }
}

TEST(Completeness, flip_adds_the_interpolated_change)
{
    for (const support::Topology& topology : support::topologies())
        for (const Basis basis : {Basis::trilinear, Basis::gimp})
            for (const Real pic : {0.0, 0.3, 1.0}) {
                transfer::PassOptions options = affine_options({Formulation::updated, basis});
                options.transfer = Transfer::flip;
                options.pic_fraction = pic;
                const Scene scene = moved(topology, options, gradient); // starts at rest, change = velocity
                for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                    const Vec3 x = support::vector_of(scene.particles.rest_position, p);
                    ASSERT_LT((support::vector_of(scene.particles.velocity, p) - gradient * x - shift).norm(), 1e-13)
                        << topology;
                }
            }
}

// A.4, 11: particles that carry v = G x + w and C = G give the nodes that field, and get it back, also across levels.
TEST(Completeness, affine_particles_map_a_linear_motion_to_the_nodes_and_back)
{
    for (const support::Topology& topology : support::topologies())
        for (const support::Weights& weights : all_weights)
            for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl}) {
                transfer::PassOptions options = affine_options(weights);
                options.stress_update = update;
                Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
                if (weights.formulation == Formulation::updated) support::disturb(6, scene);
                for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                    const Vec3 v = gradient * support::vector_of(scene.particles.position, p) + shift;
                    for (std::size_t a = 0; a < 3; ++a) {
                        scene.particles.velocity[a][p] = v[static_cast<int>(a)];
                        for (std::size_t b = 0; b < 3; ++b)
                            scene.particles.affine[3 * a + b][p] = gradient(static_cast<int>(a), static_cast<int>(b));
                    }
                }
                support::gather_sums(scene);
                support::for_each_free_node(scene.levels, [&](const grid::NodeAddress& at, const Vec3& x) {
                    const auto& sum = scene.levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
                    const Vec3 expected = sum.mass * (gradient * x + shift);
                    ASSERT_LE((support::vector_of(sum.momentum) - expected).norm(), 1e-12 * sum.mass) << topology;
                });
                transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
                support::advance(1e-9, scene);
                for (std::size_t p = 0; p < scene.particles.size(); ++p)
                    ASSERT_LT((support::matrix_of(scene.particles.affine, p) - gradient).norm(), 1e-11) << topology;
            }
}
