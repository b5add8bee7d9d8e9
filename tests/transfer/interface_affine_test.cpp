// APIC where levels meet, against sums over the free nodes formed the plain way (methods.md A.3.5): what particles give
// to masters, the matrices they get back, and what these are where the formula divides by nothing.
#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/topology.h"
#include "tests/support/basis.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

using support::Scene;
using transfer::Basis;
using transfer::Formulation;
using transfer::StressUpdate;
using transfer::Transfer;

namespace
{
transfer::PassOptions apic(Formulation formulation, StressUpdate update, Basis basis)
{
    transfer::PassOptions options;
    options.formulation = formulation;
    options.basis = basis;
    options.transfer = Transfer::apic;
    options.stress_update = update;
    options.dt = 1e-7;
    return options;
}

Scene random_scene(const support::Topology& topology, const transfer::PassOptions& options)
{
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
    support::randomise_state(31, scene);
    if (options.formulation == Formulation::updated) support::disturb(32, scene);
    support::Random random(33);
    support::prescribe_motion([&](const Vec3&) { return random.vector(-1, 1); }, scene.levels);
    return scene;
}

template <class Check>
void for_each_scheme(const Check& check)
{
    for (const support::Topology& topology : support::topologies())
        for (const Formulation formulation : {Formulation::updated, Formulation::total})
            for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
                for (const Basis basis : {Basis::trilinear, Basis::gimp}) {
                    if (basis == Basis::gimp && formulation == Formulation::total) continue;
                    check(topology, apic(formulation, update, basis));
                }
}

std::size_t index_of(const grid::NodeAddress& at)
{
    return static_cast<std::size_t>(at.leaf) * grid::tile_nodes + static_cast<std::size_t>(at.node);
}

/// p_a = sum_p m Phi_a (v + C (x_a - x_p)) for every node.
std::vector<Vec3> plain_momentum(const Scene& scene)
{
    std::vector<Vec3> momentum(scene.levels.sum.size(), Vec3::Zero());
    for (std::size_t p = 0; p < scene.particles.size(); ++p)
        for (const support::Share& share : support::basis_of(scene, p))
            momentum[index_of(share.node)] +=
                scene.particles.mass[p] * share.weight *
                (support::vector_of(scene.particles.velocity, p) +
                 support::matrix_of(scene.particles.affine, p) * (share.position - support::weight_position(scene, p)));
    return momentum;
}

void expect_plain_momentum(const Scene& scene, const support::Topology& topology)
{
    const std::vector<Vec3> expected = plain_momentum(scene);
    support::for_each_free_node(scene.levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const auto& sum = scene.levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
        ASSERT_LE((support::vector_of(sum.momentum) - expected[index_of(at)]).norm(), 1e-13 * sum.mass + 1e-20)
            << topology;
    });
}

/// B_p = sum_a Phi_a v_a (x) (x_a - x_p) of the velocities in the motion tiles.
Eigen::Matrix3d plain_moment(const Scene& scene, std::size_t p)
{
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (const support::Share& share : support::basis_of(scene, p)) {
        const auto& motion = scene.levels.motions(static_cast<std::size_t>(share.node.leaf))[share.node.node];
        moment += share.weight * support::vector_of(motion.velocity) *
                  (share.position - support::weight_position(scene, p)).transpose();
    }
    return moment;
}

bool hangs(const Scene& scene, std::size_t p)
{
    const Vec3 scaled = (support::weight_position(scene, p) - scene.levels.origin) * (1 / scene.levels.spacing0);
    const grid::CellKey key = scene.refinement.locate(scaled);
    if (key.level == 0) return false;
    const auto& cells = scene.levels.interface[static_cast<std::size_t>(key.level - 1)].hanging.slot;
    return std::binary_search(cells.begin(), cells.end(),
                              static_cast<std::size_t>(grid::active_slot(scene.levels, key.level, key.cell)));
}

/// New matrices from the motion tiles: with a second mapping they are made before the particles advance.
void take_matrices(Scene& scene)
{
    if (scene.options.stress_update == StressUpdate::musl)
        transfer::remap_momentum(scene.options, scene.strays, scene.particles, scene.levels);
    else
        transfer::advance_and_scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels,
                                      scene.leaf_work);
}

bool same_affine(const particles::Particles& a, const particles::Particles& b)
{
    return a.affine == b.affine && a.velocity == b.velocity && a.position == b.position;
}
} // namespace

TEST(InterfaceAffine, masters_get_the_momentum_of_the_plain_sum)
{
    for_each_scheme([](const support::Topology& topology, const transfer::PassOptions& options) {
        Scene scene = random_scene(topology, options);
        support::gather_sums(scene);
        expect_plain_momentum(scene, topology);
    });
}

TEST(InterfaceAffine, momentum_mapped_again_is_the_plain_sum_too)
{
    for_each_scheme([](const support::Topology& topology, const transfer::PassOptions& options) {
        if (options.stress_update == StressUpdate::usl) return;
        Scene scene = random_scene(topology, options);
        support::gather_sums(scene); // for the masses
        transfer::remap_momentum(scene.options, scene.strays, scene.particles, scene.levels);
        grid::assemble_momentum(scene.levels);
        grid::restrict_momentum(scene.levels);
        expect_plain_momentum(scene, topology);
    });
}

// C D = B, without dividing: D is as small as the weights.
TEST(InterfaceAffine, matrices_are_those_of_the_masters_positions)
{
    for_each_scheme([](const support::Topology& topology, const transfer::PassOptions& options) {
        const Scene before = random_scene(topology, options);
        Scene after = before;
        take_matrices(after);
        for (std::size_t p = 0; p < before.particles.size(); ++p) {
            ASSERT_EQ(before.particles.id[p], after.particles.id[p]);
            const Eigen::Matrix3d product =
                support::matrix_of(after.particles.affine, p) * support::affine_inertia(before, p);
            ASSERT_LT((product - plain_moment(before, p)).norm(), 1e-14) << topology;
        }
    });
}

// Away from hanging corners C is the gradient that strains the particle; in cells with hanging corners it is not, and
// for boxes never.
TEST(InterfaceAffine, matrices_are_velocity_gradients_in_all_other_cells)
{
    for_each_scheme([](const support::Topology& topology, const transfer::PassOptions& options) {
        if (options.basis == Basis::gimp) return;
        const Scene before = random_scene(topology, options);
        Scene after = before;
        take_matrices(after);
        for (std::size_t p = 0; p < before.particles.size(); ++p) {
            const Eigen::Matrix3d c = support::matrix_of(after.particles.affine, p);
            const Real difference = (c - support::velocity_gradient(before, p)).norm();
            if (hangs(before, p))
                ASSERT_GT(difference, 1e-6) << topology;
            else
                ASSERT_LT(difference, 1e-12) << topology;
        }
    });
}

// Particles on faces, edges and corners of cells, exactly or within rounding: D has zeros there.
TEST(InterfaceAffine, matrices_stay_bounded_where_particles_sit_on_cell_faces)
{
    constexpr Real places[] = {0, 0x1p-50, 0x1p-20, 0.5, 1 - 0x1p-20, 1 - 0x1p-40};
    for_each_scheme([&](const support::Topology& topology, const transfer::PassOptions& options) {
        Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
        scene.levels.origin = Vec3::Zero(); // so that positions on faces are exact
        support::Random random(41);
        particles::Particles& all = scene.particles;
        for (std::size_t n = 0; n < all.size(); ++n) {
            const grid::CellKey& key = topology.cells[n % topology.cells.size()];
            for (std::size_t a = 0; a < 3; ++a) {
                const Real at = places[random.whole(0, 5)] + key.cell[static_cast<int>(a)];
                all.position[a][n] = all.rest_position[a][n] = at * scene.levels.spacing(key.level);
            }
        }
        support::order(scene);
        const auto moved = [&](const std::function<Vec3(const Vec3&)>& velocity) {
            Scene after = scene;
            support::prescribe_motion(velocity, after.levels);
            take_matrices(after);
            return after;
        };
        const Scene turbulent = moved([&](const Vec3&) { return random.vector(-1, 1); });
        const Eigen::Matrix3d g = (Eigen::Matrix3d() << 0.3, -1.1, 0.7, 2.0, -0.4, 0.9, -0.6, 1.3, 0.5).finished();
        const Scene linear = moved([&](const Vec3& x) -> Vec3 { return g * x; });
        const Real finest = scene.levels.spacing(scene.levels.count - 1);
        // Bounds of a box that lie on a plane but for rounding are moved onto it, by up to 1e-12 cells.
        const Real tolerance = options.basis == Basis::gimp ? 1e-10 : 1e-12;
        for (std::size_t n = 0; n < all.size(); ++n) {
            // Differences of at most 2 over one spacing.
            ASSERT_LE(support::matrix_of(turbulent.particles.affine, n).cwiseAbs().maxCoeff(), 2.000001 / finest)
                << topology;
            ASSERT_LT((support::matrix_of(linear.particles.affine, n) - g).norm(), tolerance) << topology;
        }
    });
}

TEST(InterfaceAffine, any_number_of_threads_gives_the_same_bits)
{
    for_each_scheme([](const support::Topology& topology, const transfer::PassOptions& options) {
        const auto run_on = [&](int threads) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(threads));
            tbb::task_arena arena(threads);
            return arena.execute([&] {
                Scene scene = random_scene(topology, options);
                transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
                for (int n = 0; n < 5; ++n) support::advance(2e-5, scene);
                return scene.particles;
            });
        };
        EXPECT_TRUE(same_affine(run_on(1), run_on(4))) << topology;
    });
}
