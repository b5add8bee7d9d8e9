// Boxes of the basis gimp one by one: weights in closed form against those of cut boxes, what the passes make of both
// against boxes cut by every plane of the finest cells (tests/support/basis.h), on every topology; walls; same bits.
// Sums over many boxes: completeness, conservation, reference and interface_affine tests.
#include "transfer/gimp_weights.h"

#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/momentum.h"
#include "tests/support/basis.h"
#include "transfer/gimp_cover.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

using support::Scene;
using transfer::Basis;
using transfer::StressUpdate;
using transfer::Transfer;

namespace
{
transfer::PassOptions boxes(Transfer transfer, StressUpdate update = StressUpdate::usl)
{
    transfer::PassOptions options;
    options.formulation = transfer::Formulation::updated;
    options.transfer = transfer;
    options.stress_update = update;
    options.basis = Basis::gimp;
    options.dt = 1e-7;
    return options;
}

/// Random particles, some of them strays, sizes from their cells but for every third, which is as coarse as level 0.
Scene random_boxes(const support::Topology& topology, const transfer::PassOptions& options, bool mixed_sizes)
{
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
    support::randomise_state(61, scene);
    if (mixed_sizes)
        for (std::size_t p = 0; p < scene.particles.size(); p += 3) scene.particles.size_level[p] = 0;
    support::disturb(62, scene); // covers the boxes
    return scene;
}

/// Particles in order, moved by so many spacings of the finest cells: the boxes of a cell mostly reach the same nodes.
Scene moved_boxes(const support::Topology& topology, const transfer::PassOptions& options, const Vec3& shift)
{
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::regular);
    support::randomise_state(61, scene);
    const Real unit = scene.levels.spacing(scene.levels.count - 1);
    for (std::size_t a = 0; a < 3; ++a)
        for (Real& x : scene.particles.position[a]) x += shift[static_cast<int>(a)] * unit;
    support::order(scene);
    return scene;
}

/// A node seen from a particle; image nodes beyond walls lie where they are seen.
struct NodeView
{
    Real weight; // 1
    Vec3 slope;  // 1/mm
    Vec3 arm;    // mm
};

/// Three numbers for each node of every axis.
template <class Axis>
NodeView view_of(const Axis (&axis)[3], int i, int j, int k)
{
    const Axis &x = axis[0], &y = axis[1], &z = axis[2];
    return {x.weight[i] * y.weight[j] * z.weight[k],
            Vec3(x.slope[i] * y.weight[j] * z.weight[k], x.weight[i] * y.slope[j] * z.weight[k],
                 x.weight[i] * y.weight[j] * z.slope[k]),
            Vec3(x.arm[i], y.arm[j], z.arm[k])};
}

std::vector<NodeView> nodes_of_cut_box(const Scene& scene, std::size_t p)
{
    std::vector<transfer::BoxPart> parts;
    EXPECT_TRUE((transfer::BoxCutter{scene.options, scene.levels, scene.refinement}.cut(scene.particles, p, parts)));
    std::vector<NodeView> nodes;
    for (const transfer::BoxPart& part : parts)
        for (int n = 0; n < 8; ++n) nodes.push_back(view_of(part.axis, n >> 2, n >> 1 & 1, n & 1));
    return nodes;
}

std::size_t home_of(const Scene& scene, std::size_t p)
{
    std::size_t home = 0;
    while (scene.levels.cell_start[(home + 1) * grid::leaf_cells] <= p) ++home;
    return home;
}

/// Weights in closed form; none if the map does not serve the box.
std::vector<NodeView> nodes_of_whole_box(const Scene& scene, const transfer::ReachMap& map, std::size_t home,
                                         std::size_t p)
{
    transfer::BoxWeights w;
    const transfer::BoxFrame frame = transfer::box_frame(scene.options, scene.levels, home);
    transfer::box_weights<true>(frame, transfer::box_axes(frame, scene.particles, p, 1), w);
    if (!transfer::served(map, w, 0)) return {};
    struct Axis
    {
        Real weight[3], slope[3], arm[3];
    } axis[3];
    for (int a = 0; a < 3; ++a)
        for (int n = 0; n < 3; ++n)
            axis[a].weight[n] = w.weight[a][n][0], axis[a].slope[n] = w.slope[a][n][0], axis[a].arm[n] = w.arm[a][n][0];
    std::vector<NodeView> nodes;
    const int code = w.code(0);
    for (int i = 0; i < 2 + (code >> 2); ++i)
        for (int j = 0; j < 2 + (code >> 1 & 1); ++j)
            for (int k = 0; k < 2 + (code & 1); ++k) nodes.push_back(view_of(axis, i, j, k));
    return nodes;
}

/// What served and cut boxes have in common: nodes by where they are, in half spacings of the finest level.
std::map<std::array<long, 3>, NodeView> by_place(const Scene& scene, const std::vector<NodeView>& nodes)
{
    std::map<std::array<long, 3>, NodeView> sum;
    const Real unit = scene.levels.spacing(scene.levels.count - 1);
    for (const NodeView& node : nodes) {
        std::array<long, 3> place{};
        for (std::size_t a = 0; a < 3; ++a) place[a] = std::lround(node.arm[static_cast<int>(a)] * 1024 / unit);
        const auto [entry, fresh] = sum.insert({place, node});
        if (fresh) continue;
        entry->second.weight += node.weight;
        entry->second.slope += node.slope;
    }
    return sum;
}

/// What a scene's boxes are like.
struct BoxCount
{
    int served = 0, cut = 0, in_wall = 0;
};

/// Both ways for every particle of the scene that both serve.
void expect_same_weights(const Scene& scene, BoxCount& count)
{
    std::vector<transfer::ReachMap> maps(scene.levels.leaves.size());
    for (std::size_t n = 0; n < maps.size(); ++n) transfer::map_reach(scene.options, scene.levels, n, maps[n]);
    const Real h = scene.levels.spacing0;
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        const std::size_t home = home_of(scene, p);
        const auto whole = by_place(scene, nodes_of_whole_box(scene, maps[home], home, p));
        if (whole.empty()) {
            ++count.cut;
            continue;
        }
        ++count.served;
        const auto cut = by_place(scene, nodes_of_cut_box(scene, p));
        ASSERT_EQ(whole.size(), cut.size());
        for (auto a = whole.begin(), b = cut.begin(); a != whole.end(); ++a, ++b) {
            ASSERT_NEAR(a->second.weight, b->second.weight, 1e-12);
            ASSERT_LT((a->second.slope - b->second.slope).norm() * h, 1e-11);
            ASSERT_LT((a->second.arm - b->second.arm).norm(), 1e-12 * h);
        }
        for (const grid::WallPlane& wall : scene.options.walls) {
            const Real plane = scene.levels.origin[wall.axis] + wall.node0 * h;
            const Real x = scene.particles.position[static_cast<std::size_t>(wall.axis)][p];
            const Real half = scene.levels.spacing(scene.particles.size_level[p]) / (2 * scene.options.per_axis);
            if (std::abs(x - plane) < half) ++count.in_wall;
        }
    }
}
} // namespace

// No seam: boxes served by the tile of their leaf have the weights the cutter gives them.
TEST(Gimp, weights_in_closed_form_are_those_of_cut_boxes)
{
    for (const support::Topology& topology : support::topologies())
        for (const Transfer transfer : {Transfer::flip, Transfer::apic})
            for (const int per_axis : {1, 2}) {
                SCOPED_TRACE(topology.name);
                transfer::PassOptions options = boxes(transfer);
                options.per_axis = per_axis;
                BoxCount count;
                expect_same_weights(random_boxes(topology, options, true), count);
                EXPECT_GT(count.served, topology.cells.size() / 4);
                if (topology.refinement.levels() > 1 && topology.name != support::topologies().back().name) {
                    EXPECT_GT(count.cut, 0);
                }
            }
}

// A.4, 1.
TEST(Gimp, weights_are_a_partition_of_unity_and_linearly_complete)
{
    for (const support::Topology& topology : support::topologies())
        for (const Transfer transfer : {Transfer::flip, Transfer::apic})
            for (const int per_axis : {1, 2, 3}) {
                transfer::PassOptions options = boxes(transfer);
                options.per_axis = per_axis;
                const Scene scene = random_boxes(topology, options, true);
                std::vector<transfer::ReachMap> maps(scene.levels.leaves.size());
                for (std::size_t n = 0; n < maps.size(); ++n)
                    transfer::map_reach(scene.options, scene.levels, n, maps[n]);
                for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                    Real unity = 0;
                    Vec3 centre = Vec3::Zero(), none = Vec3::Zero();
                    Eigen::Matrix3d identity = Eigen::Matrix3d::Zero();
                    const std::size_t home = home_of(scene, p);
                    std::vector<NodeView> nodes = nodes_of_whole_box(scene, maps[home], home, p);
                    if (nodes.empty()) nodes = nodes_of_cut_box(scene, p);
                    for (const NodeView& node : nodes) {
                        unity += node.weight;
                        centre += node.weight * node.arm;
                        none += node.slope;
                        identity += node.arm * node.slope.transpose();
                    }
                    const Real h = scene.levels.spacing0;
                    ASSERT_NEAR(unity, 1, 1e-12) << topology;
                    ASSERT_LT(centre.norm(), 1e-12 * h) << topology;
                    ASSERT_LT(none.norm() * h, 1e-12) << topology;
                    ASSERT_LT((identity - Eigen::Matrix3d::Identity()).norm(), 1e-12) << topology;
                }
            }
}

namespace
{
/// What a particle reads of the nodes' velocities, in the plain basis.
struct PlainRead
{
    Vec3 velocity = Vec3::Zero();
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero(); // 1/ms
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();   // mm^2/ms, sum w v (x_i - x_p)^T
};

/// @param levels  reads motion
PlainRead read_plainly(const Scene& scene, const grid::Levels& levels, std::size_t p)
{
    PlainRead read;
    for (const support::Share& share : support::basis_of(scene, p)) {
        const auto& node = levels.motions(static_cast<std::size_t>(share.node.leaf))[share.node.node];
        const Vec3 velocity = support::vector_of(node.velocity);
        read.velocity += share.weight * velocity;
        read.gradient += velocity * share.slope.transpose();
        read.moment +=
            share.weight * velocity * (share.position - support::vector_of(scene.particles.position, p)).transpose();
    }
    return read;
}
} // namespace

// Any nodal field, not only a linear one: values and gradients of the particles are those of the plain basis.
TEST(Gimp, particles_read_the_plain_basis)
{
    for (const support::Topology& topology : support::topologies())
        for (const bool mixed_sizes : {false, true}) {
            Scene scene = random_boxes(topology, boxes(Transfer::apic), mixed_sizes);
            support::Random random(63);
            support::prescribe_motion([&](const Vec3&) { return random.vector(-1, 1); }, scene.levels);
            Scene after = scene;
            after.options.dt = 1;
            after.particles.stress.fill(particles::Column(scene.particles.size(), 0));
            transfer::advance_and_scatter(after.options, after.laws, after.strays, after.particles, after.levels,
                                          after.leaf_work);
            for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                const PlainRead read = read_plainly(scene, scene.levels, p);
                ASSERT_LT((support::vector_of(after.particles.velocity, p) - read.velocity).norm(), 1e-12) << topology;
                const Real half = read.gradient.trace() / 2;
                ASSERT_NEAR(after.particles.volume_ratio[p] * (1 - half), 1 + half, 1e-10) << topology;
            }
        }
}

// Boxes that share their cells are read together, by differences of nodes; all that is read, in every scheme.
TEST(Gimp, boxes_that_move_together_read_the_plain_basis)
{
    struct Scheme
    {
        Transfer transfer;
        StressUpdate update;
    };
    for (const support::Topology& topology : support::topologies())
        for (const Scheme& scheme :
             {Scheme{Transfer::flip, StressUpdate::usl}, Scheme{Transfer::flip, StressUpdate::musl},
              Scheme{Transfer::apic, StressUpdate::usl}})
            for (const Vec3& shift :
                 {Vec3(0, 0, 0), Vec3(0.1, 0.05, 0.12), Vec3(-0.1, 0, 0.2), Vec3(-0.2, -0.1, -0.05)}) {
                const Scene scene = moved_boxes(topology, boxes(scheme.transfer, scheme.update), shift);
                Scene after = scene;
                after.options.dt = 1e-2;
                support::Random random(67);
                support::prescribe_motion([&](const Vec3&) { return random.vector(-1, 1); }, after.levels);
                for (grid::NodeMotion& motion : after.levels.motion)
                    for (Real& change : motion.change) change *= -0.5;
                const grid::Levels levels = after.levels;
                transfer::advance_and_scatter(after.options, after.laws, after.strays, after.particles, after.levels,
                                              after.leaf_work);
                for (std::size_t p = 0; p < scene.particles.size(); ++p) {
                    const PlainRead read = read_plainly(scene, levels, p);
                    const Vec3 old = support::vector_of(scene.particles.velocity, p);
                    const Vec3 moved = support::vector_of(after.particles.position, p) -
                                       support::vector_of(scene.particles.position, p);
                    ASSERT_LT((moved / after.options.dt - read.velocity).norm(), 1e-11) << topology;
                    const Vec3 wanted = scheme.transfer == Transfer::apic     ? read.velocity
                                        : scheme.update == StressUpdate::musl ? old
                                                                              : Vec3(old - 0.5 * read.velocity);
                    ASSERT_LT((support::vector_of(after.particles.velocity, p) - wanted).norm(), 1e-12) << topology;
                    if (scheme.transfer == Transfer::apic) {
                        const Eigen::Matrix3d moment =
                            support::matrix_of(after.particles.affine, p) * support::affine_inertia(scene, p);
                        ASSERT_LT((moment - read.moment).norm(), 1e-13) << topology;
                    }
                    const Real strained = scheme.update == StressUpdate::musl ? -0.5 : 1;
                    const Real half = strained * after.options.dt * read.gradient.trace() / 2;
                    ASSERT_NEAR(after.particles.volume_ratio[p] * (1 - half), 1 + half, 1e-12) << topology;
                }
            }
}

TEST(Gimp, nodes_get_the_plain_sums)
{
    for (const support::Topology& topology : support::topologies())
        for (const Transfer transfer : {Transfer::flip, Transfer::apic})
            for (const bool mixed_sizes : {false, true}) {
                Scene scene = random_boxes(topology, boxes(transfer), mixed_sizes);
                for (material::Material& m : scene.laws.materials) m.cell_averaged_dilatation = false;
                for (transfer::LawConstants& c : scene.laws.constants) c.averaged_dilatation = false;
                support::gather_sums(scene);
                const auto index = [](const grid::NodeAddress& at) {
                    return static_cast<std::size_t>(at.leaf) * grid::tile_nodes + static_cast<std::size_t>(at.node);
                };
                std::vector<Real> mass(scene.levels.sum.size(), 0);
                std::vector<Vec3> momentum(mass.size(), Vec3::Zero()), force = momentum;
                for (std::size_t p = 0; p < scene.particles.size(); ++p)
                    for (const support::Share& share : support::basis_of(scene, p)) {
                        const std::size_t n = index(share.node);
                        const Real m = scene.particles.mass[p] * share.weight;
                        Vec3 v = support::vector_of(scene.particles.velocity, p);
                        if (transfer == Transfer::apic)
                            v += support::matrix_of(scene.particles.affine, p) *
                                 (share.position - support::vector_of(scene.particles.position, p));
                        mass[n] += m;
                        momentum[n] += m * v;
                        force[n] -=
                            scene.particles.rest_volume[p] * support::stress_of(scene.particles, p) * share.slope;
                    }
                support::for_each_free_node(scene.levels, [&](const grid::NodeAddress& at, const Vec3&) {
                    const auto& sum = scene.levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
                    const std::size_t n = index(at);
                    ASSERT_NEAR(sum.mass, mass[n], 1e-12 * mass[n] + 1e-20) << topology;
                    ASSERT_LT((support::vector_of(sum.momentum) - momentum[n]).norm(), 1e-12 * mass[n] + 1e-20)
                        << topology;
                    ASSERT_LT((support::vector_of(sum.force) - force[n]).norm(), 1e-13) << topology;
                });
            }
}

TEST(Gimp, any_number_of_threads_gives_the_same_bits)
{
    for (const support::Topology& topology : support::topologies())
        for (const Transfer transfer : {Transfer::flip, Transfer::apic})
            for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl}) {
                const auto run_on = [&](int threads) {
                    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
                    tbb::task_arena arena(threads);
                    return arena.execute([&] {
                        Scene scene = random_boxes(topology, boxes(transfer, update), false);
                        transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
                        for (int n = 0; n < 5; ++n) support::advance(2e-5, scene);
                        return scene.particles;
                    });
                };
                const particles::Particles one = run_on(1), two = run_on(2), four = run_on(4);
                for (const particles::Particles* other : {&two, &four}) {
                    EXPECT_EQ(one.velocity, other->velocity) << topology;
                    EXPECT_EQ(one.position, other->position) << topology;
                    EXPECT_EQ(one.stress, other->stress) << topology;
                }
            }
}

// In the total formulation, and where every box lies in one cell, boxes are points.
TEST(Gimp, boxes_at_rest_are_points)
{
    for (const support::Topology& topology : support::topologies())
        for (const transfer::Formulation formulation : {transfer::Formulation::updated, transfer::Formulation::total}) {
            const auto sums = [&](Basis basis) {
                transfer::PassOptions options = boxes(Transfer::flip);
                options.formulation = formulation;
                options.basis = basis;
                Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::regular);
                transfer::refine_voids(scene.options, scene.levels, scene.particles, scene.refinement);
                support::order(scene);
                support::randomise_state(64, scene);
                support::gather_sums(scene);
                std::vector<Vec3> force;
                support::for_each_free_node(scene.levels, [&](const grid::NodeAddress& at, const Vec3&) {
                    const auto& sum = scene.levels.sums(static_cast<std::size_t>(at.leaf))[at.node];
                    if (sum.mass > 0) force.push_back(support::vector_of(sum.force));
                });
                return force;
            };
            const std::vector<Vec3> points = sums(Basis::trilinear), extended = sums(Basis::gimp);
            ASSERT_EQ(points.size(), extended.size()) << topology;
            for (std::size_t n = 0; n < points.size(); ++n)
                ASSERT_LT((points[n] - extended[n]).norm(), 1e-13) << topology;
        }
}

namespace
{
/// Step with walls, without ordering.
void step(Scene& scene, Real dt)
{
    scene.options.dt = dt;
    const std::vector<Real> no_cutoff(static_cast<std::size_t>(scene.levels.count), Real(0));
    grid::assemble_sums(scene.levels);
    grid::restrict_sums(scene.levels);
    grid::advance_momentum(scene.options.walls, Vec3::Zero(), no_cutoff, dt, scene.levels);
    grid::prolong_motion(scene.levels);
    grid::fill_motion_halos(scene.levels);
    if (scene.options.stress_update == StressUpdate::musl) {
        transfer::remap_momentum(scene.options, scene.strays, scene.particles, scene.levels);
        grid::assemble_momentum(scene.levels);
        grid::restrict_momentum(scene.levels);
        grid::remap_velocity(scene.options.walls, no_cutoff, scene.levels);
        grid::prolong_motion(scene.levels);
        grid::fill_motion_halos(scene.levels);
    }
    transfer::advance_and_scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels,
                                  scene.leaf_work);
    ASSERT_FALSE(scene.strays.outside);
}

/// The particles at x > origin of a scene, their mirror images on the other side as well if `whole`.
Scene mirrored(Scene scene, bool whole)
{
    particles::Particles& p = scene.particles;
    std::vector<std::uint32_t> right;
    const Real wall = scene.levels.origin[0];
    for (std::uint32_t n = 0; n < p.size(); ++n)
        if (p.position[0][n] > wall) right.push_back(n);
    // Every particle twice (the second half becomes the image), or once.
    const std::size_t half = right.size(), count = whole ? 2 * half : half;
    const auto pick = [&](const auto&, auto& column) {
        if (column.empty()) return;
        auto chosen = column;
        chosen.resize(count);
        for (std::size_t n = 0; n < count; ++n) chosen[n] = column[right[n % half]];
        column = std::move(chosen);
    };
    particles::Particles::for_each_real(p, pick);
    particles::Particles::for_each_integer(p, pick);
    for (std::uint32_t n = 0; n < count; ++n) {
        p.id[n] = n;
        if (n < half) continue;
        p.position[0][n] = 2 * wall - p.position[0][n];
        p.velocity[0][n] = -p.velocity[0][n];
        p.stress[3][n] = -p.stress[3][n];
        p.stress[5][n] = -p.stress[5][n];
        for (const std::size_t entry : {1U, 2U, 3U, 6U})
            if (!p.affine[entry].empty()) p.affine[entry][n] = -p.affine[entry][n];
    }
    support::order(scene);
    return scene;
}

Scene mirrored_block(const support::Topology& topology, const transfer::PassOptions& options, bool whole)
{
    Scene scene = support::scene_of(topology, options, {support::soft_elastic()}, support::Layout::random);
    support::randomise_state(66, scene);
    return mirrored(std::move(scene), whole);
}
} // namespace

// A symmetric block and its half with a symmetry plane, boxes reaching through it: random ones, and such that share
// their cells among the images.
TEST(Gimp, half_a_block_moves_like_the_whole_one)
{
    const support::Topology coarse = support::topology_of("one level", 1, 2, [](const auto&) { return false; });
    const support::Topology fine = support::topology_of(
        "two levels", 2, 2, [](const auto& key) { return key.cell[1] < 0; }); // the interface meets the wall
    for (const support::Topology& topology : {coarse, fine})
        for (const Transfer transfer : {Transfer::flip, Transfer::apic})
            for (const StressUpdate update : {StressUpdate::usl, StressUpdate::musl})
                for (const bool random : {true, false}) {
                    transfer::PassOptions options = boxes(transfer, update);
                    const auto block = [&](bool whole) {
                        return random ? mirrored_block(topology, options, whole)
                                      : mirrored(moved_boxes(topology, options, {-0.1, 0.05, 0.12}), whole);
                    };
                    Scene whole = block(true);
                    options.walls = {{0, 0}};
                    Scene half = block(false);
                    for (int n = 0; n < 5; ++n) {
                        step(whole, 1e-6);
                        step(half, 1e-6);
                    }
                    std::vector<std::size_t> place(whole.particles.size());
                    for (std::size_t p = 0; p < place.size(); ++p) place[whole.particles.id[p]] = p;
                    for (std::size_t p = 0; p < half.particles.size(); ++p) {
                        const std::size_t q = place[half.particles.id[p]];
                        ASSERT_LT((support::vector_of(half.particles.velocity, p) -
                                   support::vector_of(whole.particles.velocity, q))
                                      .norm(),
                                  1e-11)
                            << topology;
                        ASSERT_LT(
                            (support::stress_of(half.particles, p) - support::stress_of(whole.particles, q)).norm(),
                            1e-9)
                            << topology;
                    }
                }
}

TEST(Gimp, weights_in_closed_form_reach_through_walls)
{
    const support::Topology fine =
        support::topology_of("two levels", 2, 2, [](const auto& key) { return key.cell[1] < 0; });
    BoxCount count;
    for (const Transfer transfer : {Transfer::flip, Transfer::apic}) {
        transfer::PassOptions options = boxes(transfer);
        options.walls = {{0, 0}};
        expect_same_weights(mirrored_block(fine, options, false), count);
        options.walls = {{0, 0}, {1, 2}, {2, -2}}; // faces of the block: an edge and a corner of images
        expect_same_weights(mirrored_block(fine, options, false), count);
    }
    EXPECT_GT(count.served, 1000);
    EXPECT_GT(count.in_wall, 100);
}

// Fine particles at a free surface reach into coarse cells without particles: those become fine, others stay.
TEST(Gimp, empty_coarse_cells_that_fine_boxes_reach_are_refined)
{
    const support::Topology topology =
        support::topology_of("flat face", 2, 2, [](const auto& key) { return key.cell[0] < 0; });
    Scene scene =
        support::scene_of(topology, boxes(Transfer::flip), {support::soft_elastic()}, support::Layout::regular);
    for (Real& y : scene.particles.position[1]) y += 0.05;
    const Index3 beyond(-1, 2, 0), metal(0, 1, 0), far(-1, 3, 0);
    EXPECT_FALSE(scene.refinement.subdivided(0, beyond));
    transfer::refine_voids(scene.options, scene.levels, scene.particles, scene.refinement);
    EXPECT_TRUE(scene.refinement.subdivided(0, beyond));
    EXPECT_FALSE(scene.refinement.subdivided(0, metal)); // coarse particles sit in it
    EXPECT_FALSE(scene.refinement.subdivided(0, far));
    support::order(scene);
    EXPECT_FALSE(scene.strays.outside);
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        std::vector<transfer::BoxPart> parts;
        ASSERT_TRUE(
            (transfer::BoxCutter{scene.options, scene.levels, scene.refinement}.cut(scene.particles, p, parts)));
    }
}

// Whoever places the particle names it: here its cells, which no index can name, must only not be looked for.
TEST(Gimp, boxes_flung_beyond_all_cells_are_not_cut)
{
    Scene scene = support::scene_of(support::topologies()[1], boxes(Transfer::flip), {support::soft_elastic()},
                                    support::Layout::regular);
    for (const Real away : {1e12, -1e12, std::numeric_limits<Real>::quiet_NaN()}) {
        for (std::size_t a = 0; a < 3; ++a) scene.particles.position[a][5] = away;
        std::vector<transfer::BoxPart> parts;
        EXPECT_FALSE(
            (transfer::BoxCutter{scene.options, scene.levels, scene.refinement}.cut(scene.particles, 5, parts)));
        EXPECT_TRUE(parts.empty());
    }
}
