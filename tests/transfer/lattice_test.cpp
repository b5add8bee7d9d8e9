/// transfer/lattice.h and grid/nodal.h against the page of tests/support/dense_nodal.h, against FLIP, and by
/// themselves.
#include "transfer/lattice.h"

#include "grid/halo.h"
#include "grid/interface.h"
#include "material/elastic.h"
#include "particles/tensors.h"
#include "tests/support/lattice_run.h"
#include "transfer/cell_squeeze.h"
#include "transfer/lattice_squeeze.h"
#include "transfer/solid_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using support::DenseNodal;
using support::LatticeRun;
using support::Scene;
using transfer::Precision;

namespace
{
constexpr Precision precisions[] = {Precision::f64, Precision::mixed};
constexpr Real dt = 1e-5; // ms; the finest cells allow 5e-5

/// A plastic and an elastic one; only the first averages its dilatation, if any does.
std::vector<material::Material> two_metals(bool averaged)
{
    std::vector<material::Material> metals = support::two_metals(10, averaged);
    metals[1].cell_averaged_dilatation = false;
    return metals;
}

/// The same with decohesion in the first one, weak enough to break in the tests below.
std::vector<material::Material> breaking_metals(bool smoothed)
{
    std::vector<material::Material> metals = two_metals(true);
    material::Decohesion law;
    law.s_max = 9;
    law.tau_max = 5.2;
    law.u0 = 3e-4;
    law.friction = 0.3;
    law.smoothed_onset = smoothed;
    metals[0].decohesion = law;
    return metals;
}

/// Largest difference of a column's entries.
Real apart(const particles::Column& a, const particles::Column& b)
{
    EXPECT_EQ(a.size(), b.size());
    Real largest = 0;
    for (std::size_t p = 0; p < a.size(); ++p)
        largest = std::abs(a[p] - b[p]) <= largest ? largest : std::abs(a[p] - b[p]); // a NaN stays
    return largest;
}

template <std::size_t N>
Real apart(const std::array<particles::Column, N>& a, const std::array<particles::Column, N>& b)
{
    Real largest = 0;
    for (std::size_t n = 0; n < N; ++n) largest = std::max(apart(a[n], b[n]), largest);
    return largest;
}

template <std::size_t N>
Real size_of(const std::array<particles::Column, N>& columns)
{
    Real largest = 0;
    for (const particles::Column& column : columns)
        for (const Real entry : column) largest = std::max(largest, std::abs(entry));
    return largest;
}

/// Difference of everything a step changes, each relative to what it is measured by.
Real difference(const particles::Particles& a, const particles::Particles& b, Real spacing)
{
    Real largest = apart(a.position, b.position) / spacing;
    largest = std::max(largest, apart(a.velocity, b.velocity) / size_of(b.velocity));
    largest = std::max(largest, apart(a.stress, b.stress) / size_of(b.stress));
    largest = std::max(largest, apart(a.deformation_gradient, b.deformation_gradient));
    return std::max(largest, apart(a.eq_plastic_strain, b.eq_plastic_strain));
}

/// The dense points as columns.
particles::Particles columns_of(const DenseNodal& dense, particles::Particles particles)
{
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const support::NodalPoint& point = dense.points[p];
        const Vec3 x = point.rest_position + dense.displacement(p), v = dense.velocity(p);
        for (std::size_t a = 0; a < 3; ++a) {
            particles.position[a][p] = x[static_cast<int>(a)];
            particles.velocity[a][p] = v[static_cast<int>(a)];
        }
        for (std::size_t n = 0; n < 6; ++n) particles.stress[n][p] = point.stress.s[n];
        for (std::size_t n = 0; n < 9; ++n) particles.deformation_gradient[n][p] = point.deformation_gradient.m[n];
        particles.eq_plastic_strain[p] = point.eq_plastic_strain;
    }
    return particles;
}

Real difference(const LatticeRun& run, const DenseNodal& dense)
{
    const particles::Particles sparse = support::filled(run);
    return difference(sparse, columns_of(dense, sparse), run.scene.levels.spacing0);
}

/// Velocity and displacement of the free nodes by position, carried to slaves and halos.
void prescribe(const std::function<Vec3(const Vec3&)>& velocity, const std::function<Vec3(const Vec3&)>& displacement,
               grid::Levels& levels)
{
    support::prescribe_motion(velocity, levels);
    support::for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        const Vec3 u = displacement(x);
        for (std::size_t a = 0; a < 3; ++a)
            levels.motions(static_cast<std::size_t>(at.leaf))[at.node].change[a] = u[static_cast<int>(a)];
    });
    grid::prolong_motion(levels);
    grid::fill_motion_halos(levels);
}

template <class Columns>
bool released(const Columns& columns)
{
    for (const particles::Column& column : columns)
        if (column.capacity() != 0) return false;
    return true;
}

class EveryTopology : public testing::TestWithParam<support::Topology>
{};
} // namespace

INSTANTIATE_TEST_SUITE_P(Lattice, EveryTopology, testing::ValuesIn(support::topologies()));

// From rest FLIP has nothing to smooth: both paths make the same step.
TEST_P(EveryTopology, one_step_from_rest_is_that_of_flip)
{
    Scene flip = support::cut_scene(GetParam(), two_metals(true), 1);
    flip.options.transfer = transfer::Transfer::flip;
    support::stir(2, 20, 0, flip);
    LatticeRun run = support::lattice_run(flip, Precision::f64);
    support::advance(dt, flip);
    support::advance(dt, run);

    const particles::Particles nodal = support::filled(run);
    EXPECT_LT(difference(nodal, flip.particles, flip.levels.spacing0), 1e-14);
    EXPECT_GT(flip.plastic_work, 0);
    EXPECT_NEAR(run.plastic_work / flip.plastic_work, 1, 1e-13);
    Real velocity = 0, force = 0, fastest = 0, strongest = 0;
    support::for_each_free_node(flip.levels, [&](const grid::NodeAddress& at, const Vec3&) {
        const auto leaf = static_cast<std::size_t>(at.leaf);
        const Vec3 v = support::vector_of(flip.levels.motions(leaf)[at.node].velocity);
        velocity = std::max(
            velocity, (support::vector_of(run.scene.levels.motions(leaf)[at.node].velocity) - v).cwiseAbs().maxCoeff());
        fastest = std::max(fastest, v.norm());
    });
    // Neither force is assembled yet: halos hold their part.
    for (std::size_t n = 0; n < flip.levels.sum.size(); ++n) {
        const Vec3 f = support::vector_of(flip.levels.sum[n].force);
        force = std::max(force, (support::vector_of(run.scene.levels.force[n].force) - f).cwiseAbs().maxCoeff());
        strongest = std::max(strongest, f.norm());
    }
    EXPECT_LT(velocity, 1e-13 * fastest);
    EXPECT_LT(force, 1e-13 * strongest);
}

TEST_P(EveryTopology, twenty_steps_of_a_plastic_cut_body_are_those_of_the_plain_scheme)
{
    const std::vector<grid::WallPlane> walls{{1, 1}};
    const Vec3 gravity(300, -500, 200);
    for (const bool averaged : {false, true}) {
        Scene scene = support::cut_scene(GetParam(), two_metals(averaged), 3);
        support::stir(4, 10, 30, scene);
        DenseNodal dense = support::dense_nodal(scene, walls, gravity);
        LatticeRun run = support::lattice_run(scene, Precision::f64, walls, gravity);
        for (int n = 0; n < 20; ++n) {
            support::advance(dt, run);
            dense.step(dt);
        }
        EXPECT_LT(difference(run, dense), 1e-11) << averaged;
        EXPECT_GT(dense.plastic_work, 0);
        EXPECT_NEAR(run.plastic_work / dense.plastic_work, 1, 1e-11);
    }
}

// Slivers at a rim would be squeezed to nothing while their cell keeps its volume.
TEST(Lattice, what_has_lost_half_of_its_volume_leaves_the_mean_dilatation)
{
    Scene scene = support::cut_scene(support::topologies()[0], two_metals(true), 3);
    support::stir(4, 10, 4000, scene);
    DenseNodal dense = support::dense_nodal(scene);
    LatticeRun run = support::lattice_run(scene, Precision::f64);
    int collapsed = 0, whole = 0;
    for (int n = 0; n < 20; ++n) {
        support::advance(dt, run);
        dense.step(dt);
        for (const support::NodalPoint& p : dense.points) {
            const Real j = core::determinant(p.deformation_gradient);
            collapsed += j < transfer::least_averaged_volume && j > 0;
            whole += j >= transfer::least_averaged_volume;
        }
    }
    EXPECT_GT(collapsed, 0);
    EXPECT_GT(whole, collapsed);
    EXPECT_LT(difference(run, dense), 1e-9);
}

TEST(Lattice, two_hundred_steps_are_those_of_the_plain_scheme)
{
    for (const std::size_t topology : {0U, 2U, 4U}) {
        Scene scene = support::cut_scene(support::topologies()[topology], two_metals(true), 5);
        support::stir(6, 10, 30, scene);
        DenseNodal dense = support::dense_nodal(scene);
        LatticeRun run = support::lattice_run(scene, Precision::f64);
        for (int n = 0; n < 200; ++n) {
            support::advance(dt, run);
            dense.step(dt);
        }
        EXPECT_LT(difference(run, dense), 1e-11) << support::topologies()[topology];
        EXPECT_NEAR(run.plastic_work / dense.plastic_work, 1, 1e-11);
    }
}

// Onset, softening, separation, closure and friction, with intact neighbours in the same cells.
TEST(Lattice, a_breaking_body_is_that_of_the_plain_scheme)
{
    for (const bool smoothed : {false, true}) {
        Scene scene = support::cut_scene(support::topologies()[2], breaking_metals(smoothed), 7);
        support::stir(8, 5, 60, scene);
        DenseNodal dense = support::dense_nodal(scene);
        LatticeRun run = support::lattice_run(scene, Precision::f64);
        for (int n = 0; n < 150; ++n) {
            support::advance(dt, run);
            dense.step(dt);
        }
        int softening = 0, separated = 0, closed = 0;
        const particles::Particles& particles = run.scene.particles;
        for (std::size_t p = 0; p < particles.size(); ++p) {
            ASSERT_EQ(particles.crack[p] >= 0, dense.points[p].crack.has_value()) << "particle " << p;
            if (particles.crack[p] < 0) continue;
            const core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
            const core::Crack& expected = *dense.points[p].crack;
            EXPECT_NEAR(crack.damage, expected.damage, 1e-8);
            EXPECT_NEAR(crack.opening, expected.opening, 1e-10);
            EXPECT_EQ(crack.onset_time, expected.onset_time);
            EXPECT_EQ(crack.particle_id, particles.id[p]);
            (expected.damage < 1 ? softening : separated) += 1;
            closed += expected.damage >= 1 && expected.opening == 0 ? 1 : 0;
        }
        EXPECT_GT(softening, 10);
        EXPECT_GT(separated, 100);
        EXPECT_GT(closed, 10);
        EXPECT_LT(difference(run, dense), 1e-8);
        EXPECT_NEAR(run.decohesion_work / dense.decohesion_work, 1, 1e-9);
        EXPECT_NEAR(run.plastic_work / dense.plastic_work, 1, 1e-9);
    }
}

TEST(Lattice, single_precision_of_the_particles_changes_the_fifth_digit)
{
    for (const std::size_t topology : {0U, 2U, 4U}) {
        Scene scene = support::cut_scene(support::topologies()[topology], two_metals(true), 9);
        support::stir(10, 10, 30, scene);
        LatticeRun full = support::lattice_run(scene, Precision::f64);
        LatticeRun mixed = support::lattice_run(scene, Precision::mixed);
        for (int n = 0; n < 200; ++n) {
            support::advance(dt, full);
            support::advance(dt, mixed);
        }
        const Real apart = difference(support::filled(mixed), support::filled(full), scene.levels.spacing0);
        EXPECT_LT(apart, 2e-5) << support::topologies()[topology];
        EXPECT_GT(apart, 1e-8);
        EXPECT_NEAR(mixed.plastic_work / full.plastic_work, 1, 1e-5);
    }
}

TEST(Lattice, single_precision_breaks_the_same_body)
{
    Scene scene = support::cut_scene(support::topologies()[2], breaking_metals(true), 7);
    support::stir(8, 5, 60, scene);
    LatticeRun full = support::lattice_run(scene, Precision::f64),
               mixed = support::lattice_run(scene, Precision::mixed);
    for (int n = 0; n < 150; ++n) {
        support::advance(dt, full);
        support::advance(dt, mixed);
    }
    const auto cracks = [](const LatticeRun& run) { return static_cast<Real>(run.scene.particles.cracks.size()); };
    EXPECT_GT(cracks(full), 100);
    EXPECT_NEAR(cracks(mixed) / cracks(full), 1, 0.02);
    EXPECT_NEAR(mixed.decohesion_work / full.decohesion_work, 1, 0.01);
}

namespace
{
/// Refused, and nothing changed.
void expect_refused(Scene& scene)
{
    for (const Precision precision : precisions) {
        particles::Particles particles = scene.particles;
        transfer::Lattice lattice;
        EXPECT_FALSE(transfer::enter_lattice(precision, scene.levels, particles, lattice));
        EXPECT_FALSE(lattice.in_use());
        std::vector<const particles::Column*> before;
        particles::Particles::for_each_real(scene.particles, [&](const auto&, auto& c) { before.push_back(&c); });
        std::size_t n = 0;
        particles::Particles::for_each_real(
            particles, [&](const auto& name, const auto& column) { EXPECT_EQ(*before[n++], column) << name; });
    }
}

Scene full_scene()
{
    transfer::PassOptions options;
    Scene scene =
        support::scene_of(support::topologies()[1], options, {support::soft_elastic()}, support::Layout::regular);
    support::randomise_state(11, scene);
    return scene;
}
} // namespace

TEST(Lattice, a_particle_off_its_slot_is_refused)
{
    for (const std::size_t axis : {0U, 1U, 2U}) {
        Scene scene = full_scene();
        scene.particles.rest_position[axis][77] += 1e-4 * scene.levels.spacing0;
        expect_refused(scene);
    }
}

TEST(Lattice, two_particles_on_one_slot_are_refused)
{
    Scene scene = full_scene();
    for (const std::size_t cell : {0U, 9U}) {
        Scene doubled = scene;
        const std::size_t p = doubled.particles.size() / 2 + cell;
        for (particles::Column& column : doubled.particles.rest_position) column[p] = column[p ^ 1];
        expect_refused(doubled);
    }
}

TEST(Lattice, any_other_number_of_particles_is_refused)
{
    Scene scene = support::scene_of(support::topologies()[0], {}, {support::soft_elastic()}, support::Layout::random);
    expect_refused(scene);
}

TEST(Lattice, rounding_of_rest_positions_is_not)
{
    Scene scene = full_scene();
    for (particles::Column& column : scene.particles.rest_position)
        for (Real& x : column) x += 1e-10 * scene.levels.spacing0;
    transfer::Lattice lattice;
    EXPECT_TRUE(transfer::enter_lattice(Precision::f64, scene.levels, scene.particles, lattice));
    EXPECT_TRUE(lattice.in_use());
}

// An affine displacement is exact at every node of every level; a trilinear one on a single level.
TEST_P(EveryTopology, columns_come_back_from_nodes_and_blocks)
{
    Eigen::Matrix3d strain, spin;
    strain << 0.1, -0.2, 0.05, 0.3, 0.2, -0.1, 0.15, 0.25, -0.3;
    spin << 7, -3, 2, 1, 5, -4, 6, -2, 8;
    const Vec3 shift(3, -5, 7), drift(-20, 10, 30);
    for (const Precision precision : precisions) {
        Scene scene = support::cut_scene(GetParam(), two_metals(true), 12);
        support::stir(13, 10, 1, scene);
        support::Random random(14);
        for (Real& entry : scene.particles.eq_plastic_strain) entry = random.between(0, 1);
        const particles::Particles before = scene.particles;
        LatticeRun run = support::lattice_run(scene, precision);
        particles::Particles& particles = run.scene.particles;
        EXPECT_TRUE(released(particles.position) && released(particles.velocity) && released(particles.stress) &&
                    released(particles.deformation_gradient) && released(std::array{particles.eq_plastic_strain}));
        EXPECT_EQ(particles.rest_position, before.rest_position);

        prescribe([&](const Vec3& x) -> Vec3 { return drift + spin * x; },
                  [&](const Vec3& x) -> Vec3 { return shift + strain * x; }, run.scene.levels);
        for (int round = 0; round < 2; ++round) {
            transfer::fill_columns(run.scene.levels, run.lattice, particles);
            for (std::size_t p = 0; p < particles.size(); ++p) {
                const Vec3 rest = support::vector_of(before.rest_position, p);
                const Vec3 u = shift + strain * rest;
                EXPECT_LT((support::vector_of(particles.position, p) - rest - u).norm(), 1e-13);
                EXPECT_LT((support::vector_of(particles.velocity, p) - drift - spin * rest).norm(), 1e-12);
                EXPECT_LT((support::matrix_of(particles.deformation_gradient, p) - Eigen::Matrix3d::Identity() - strain)
                              .norm(),
                          1e-12);
                EXPECT_LT((transfer::displacement_of(particles, run.scene.levels, p) - u).norm(), 1e-13);
            }
            const auto stored = [&](Real value) {
                return precision == Precision::mixed ? Real(static_cast<float>(value)) : value;
            };
            for (std::size_t p = 0; p < particles.size(); ++p) {
                EXPECT_EQ(particles.eq_plastic_strain[p], stored(before.eq_plastic_strain[p]));
                for (std::size_t n = 0; n < 6; ++n) EXPECT_EQ(particles.stress[n][p], stored(before.stress[n][p]));
            }
            EXPECT_EQ(particles.rest_volume, before.rest_volume);
            transfer::drop_columns(particles);
            EXPECT_TRUE(released(particles.position) && released(particles.stress));
        }
    }
}

TEST(Lattice, a_trilinear_displacement_comes_back)
{
    Scene scene = support::cut_scene(support::topologies()[0], two_metals(true), 15);
    LatticeRun run = support::lattice_run(scene, Precision::f64);
    const auto u = [](const Vec3& x) -> Vec3 { return 0.01 * x[0] * x[1] * x[2] * Vec3(1, -2, 3); };
    prescribe([](const Vec3& x) { return x; }, u, run.scene.levels);
    const particles::Particles particles = support::filled(run);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 x = support::vector_of(particles.rest_position, p);
        const Vec3 slope = 0.01 * Vec3(x[1] * x[2], x[2] * x[0], x[0] * x[1]);
        EXPECT_LT((support::vector_of(particles.position, p) - x - u(x)).norm(), 1e-14);
        EXPECT_LT((support::matrix_of(particles.deformation_gradient, p) - Eigen::Matrix3d::Identity() -
                   Vec3(1, -2, 3) * slope.transpose())
                      .norm(),
                  1e-13);
    }
}

TEST_P(EveryTopology, a_translation_strains_nothing_to_the_bit)
{
    for (const Precision precision : precisions) {
        LatticeRun run = support::lattice_run(support::cut_scene(GetParam(), two_metals(true), 16), precision);
        run.scene.options.dt = dt;
        const Vec3 velocity(1234.5678, -0.1, 98765.4321), displacement(1e5 / 3, -7.7e6, 0.123456789);
        prescribe([&](const Vec3&) { return velocity; }, [&](const Vec3&) { return displacement; }, run.scene.levels);
        transfer::advance_lattice(run.scene.options, run.scene.laws, run.lattice, run.scene.particles, run.scene.levels,
                                  run.scene.leaf_work);
        const particles::Particles particles = support::filled(run);
        EXPECT_EQ(size_of(particles.stress), 0);
        EXPECT_EQ(size_of(std::array{particles.eq_plastic_strain}), 0);
        for (const transfer::LeafWork& work : run.scene.leaf_work) EXPECT_EQ(work.plastic, 0);
        for (const grid::NodeForce& node : run.scene.levels.force)
            for (const Real f : node.force) EXPECT_EQ(f, 0);
        for (std::size_t n = 0; n < 9; ++n)
            for (const Real entry : particles.deformation_gradient[n]) EXPECT_EQ(entry, n % 4 == 0 ? 1 : 0);
    }
}

TEST(Lattice, single_precision_does_not_see_the_distance_travelled)
{
    Eigen::Matrix3d strain;
    strain << 1e-3, -2e-3, 0, 3e-3, 2e-3, -1e-3, 1e-3, 0, -3e-3;
    std::vector<grid::NodeForce> force[2];
    for (const bool far : {false, true}) {
        LatticeRun run = support::lattice_run(full_scene(), Precision::mixed);
        run.scene.options.dt = dt;
        const Vec3 away = far ? Vec3(1e4, -2e4, 3e4) : Vec3(0, 0, 0);
        prescribe([&](const Vec3& x) -> Vec3 { return away + strain * x / dt; },
                  [&](const Vec3& x) -> Vec3 { return away + strain * x; }, run.scene.levels);
        transfer::advance_lattice(run.scene.options, run.scene.laws, run.lattice, run.scene.particles, run.scene.levels,
                                  run.scene.leaf_work);
        force[far] = run.scene.levels.force;
    }
    Real apart = 0, largest = 0;
    for (std::size_t n = 0; n < force[0].size(); ++n)
        for (std::size_t a = 0; a < 3; ++a) {
            apart = std::max(apart, std::abs(force[1][n].force[a] - force[0][n].force[a]));
            largest = std::max(largest, std::abs(force[0][n].force[a]));
        }
    EXPECT_GT(largest, 0);
    EXPECT_LT(apart, 1e-4 * largest);
}

namespace
{
/// Root of the largest mean over a corner of q^2 min(1, J), by masses, over the particles [begin, end) of a cell that
/// transmit force.
Real corner_squeeze(const Scene& scene, const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    Real largest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Real sum = 0, mass = 0;
        for (std::size_t p = begin; p < end; ++p) {
            const std::int32_t crack = particles.crack[p];
            if (crack >= 0 && particles.cracks[static_cast<std::size_t>(crack)].damage >= 1) continue;
            const Real spacing = scene.levels.spacing(particles.size_level[p]);
            Real weight = particles.mass[p];
            for (std::size_t a = 0; a < 3; ++a) {
                const Real x = (particles.rest_position[a][p] - scene.levels.origin[static_cast<int>(a)]) / spacing;
                const Real upper = x - std::floor(x);
                weight *= (corner >> (2 - a) & 1) != 0 ? upper : 1 - upper;
            }
            const core::Mat<Real> f = particles::deformation_of(particles, p);
            const Real squeeze = transfer::cell_squeeze(f);
            sum += weight * squeeze * squeeze * std::min(Real(1), core::determinant(f));
            mass += weight;
        }
        if (mass > 0) largest = std::max(largest, sum / mass);
    }
    return std::sqrt(largest);
}
} // namespace

// Energy as solver/audit.cpp forms it from particles, squeeze by the formula of transfer/lattice_squeeze.h.
TEST(Lattice, a_survey_is_that_of_the_particles)
{
    for (const Precision precision : precisions) {
        const Real tolerance = precision == Precision::mixed ? 1e-5 : 1e-12;
        Scene scene = support::cut_scene(support::topologies()[2], breaking_metals(true), 7);
        support::stir(8, 5, 60, scene);
        LatticeRun run = support::lattice_run(scene, precision);
        for (int n = 0; n < 120; ++n) support::advance(dt, run);
        std::vector<transfer::LatticeSurvey> survey;
        transfer::survey_lattice(run.scene.laws, run.lattice, run.scene.particles, run.scene.levels, survey);
        std::vector<transfer::LatticeSurvey> without_energy;
        transfer::survey_squeeze(run.scene.laws, run.lattice, run.scene.particles, run.scene.levels, without_energy);
        const particles::Particles particles = support::filled(run);
        ASSERT_EQ(survey.size(), run.scene.levels.leaves.size());
        for (std::size_t n = 0; n < survey.size(); ++n) {
            Real elastic = 0, squeeze = 0;
            const std::uint32_t* start = run.scene.levels.cell_start.data() + n * grid::leaf_cells;
            for (std::uint32_t p = start[0]; p < start[grid::leaf_cells]; ++p) {
                Real volume = particles.rest_volume[p] * core::determinant(particles::deformation_of(particles, p));
                if (particles.crack[p] >= 0)
                    volume *= transfer::solid_share(particles.cracks[static_cast<std::size_t>(particles.crack[p])]);
                elastic += volume * material::elastic_energy(run.scene.laws.materials[particles.material[p]].elastic,
                                                             particles::stress_of(particles, p));
            }
            for (int c = 0; c < grid::leaf_cells; ++c)
                squeeze = std::max(squeeze, corner_squeeze(run.scene, particles, start[c], start[c + 1]));
            EXPECT_NEAR(survey[n].elastic, elastic, tolerance * elastic);
            EXPECT_NEAR(survey[n].squeeze, squeeze, tolerance * squeeze);
            EXPECT_EQ(without_energy[n].squeeze, survey[n].squeeze);
            EXPECT_EQ(without_energy[n].worst, survey[n].worst);
        }
    }
}

TEST(Lattice, a_survey_shows_inverted_and_lost_cells)
{
    for (const Precision precision : precisions)
        for (const Real bad : {-2.0, std::numeric_limits<Real>::quiet_NaN()}) {
            LatticeRun run = support::lattice_run(full_scene(), precision);
            prescribe([](const Vec3& x) { return x; },
                      [&](const Vec3& x) -> Vec3 {
                          return {x[0] > 1 ? bad * x[0] : 0, 0, 0};
                      },
                      run.scene.levels);
            std::vector<transfer::LatticeSurvey> survey;
            transfer::survey_lattice(run.scene.laws, run.lattice, run.scene.particles, run.scene.levels, survey);
            bool lost = false;
            for (const transfer::LatticeSurvey& leaf : survey) lost = lost || !std::isfinite(leaf.squeeze);
            EXPECT_TRUE(lost) << bad;
        }
}
