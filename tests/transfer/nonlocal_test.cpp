/// The ball of the nonlocal onset (transfer/ball.h) and the rule that keeps cracks apart.
#include "transfer/nonlocal_cracks.h"
#include "transfer/nonlocal_onset.h"

#include "grid/topology.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

using support::Scene;

namespace
{
/// Fill every component with a function of the place at rest: `value(component, place)`.
template <class Value>
void put_stress(const Value& value, Scene& scene)
{
    for (std::size_t p = 0; p < scene.particles.size(); ++p)
        for (std::size_t n = 0; n < 6; ++n)
            scene.particles.stress[n][p] = value(n, support::vector_of(scene.particles.rest_position, p));
}

template <class Counts>
core::Sym<Real> mean_of(const Scene& scene, const transfer::Ball& ball, const Counts& counts)
{
    const auto stress_at = [&](std::uint32_t p) {
        core::Sym<Real> s{};
        for (std::size_t n = 0; n < 6; ++n) s.s[n] = scene.particles.stress[n][p];
        return s;
    };
    return transfer::mean_stress(ball, stress_at, counts);
}

core::Sym<Real> mean_of(const Scene& scene, const transfer::Ball& ball)
{
    return mean_of(scene, ball, [](std::uint32_t) { return true; });
}

/// Cells of 0.5 mm about the origin of the lattice: those of a block of side 6 that `keep` takes.
template <class Keep>
Scene block(const std::vector<grid::WallPlane>& walls, const Keep& keep,
            const material::Material& metal = support::soft_elastic())
{
    support::Topology topology = support::topology_of("block", 1, 3, [](const grid::CellKey&) { return false; });
    std::erase_if(topology.cells, [&](const grid::CellKey& key) { return !keep(key.cell); });
    transfer::PassOptions options;
    options.walls = walls;
    return support::scene_of(topology, options, {metal}, support::Layout::regular);
}

bool everything(const Index3&)
{
    return true;
}

std::size_t slot_at(const Scene& scene, int level, const Index3& cell)
{
    return static_cast<std::size_t>(grid::active_slot(scene.levels, level, cell));
}

transfer::Ball ball_at(const Scene& scene, int level, const Index3& cell, Real radius, std::uint8_t material = 0)
{
    return transfer::ball_about(scene.options, scene.levels, scene.particles,
                                transfer::occupied_cell(scene.levels, slot_at(scene, level, cell)), material, radius);
}

/// The metal ahead of cell 0 of level 0.
transfer::Ball ball_ahead(const Scene& scene, const Vec3& way, Real length)
{
    return transfer::ball_ahead(scene.options, scene.levels, scene.particles,
                                transfer::occupied_cell(scene.levels, slot_at(scene, 0, {0, 0, 0})), 0, way, length);
}

/// A crack across y that is through.
core::Crack through_crack()
{
    core::Crack crack;
    crack.normal = {0, 1, 0};
    crack.damage = 1;
    crack.normal_strength = crack.tangential_strength = 1;
    crack.effective_length = 0.5;
    return crack;
}

/// Give all particles of a cell of level 0 a crack.
void put_crack(const Index3& cell, const core::Crack& crack, Scene& scene)
{
    const std::size_t slot = slot_at(scene, 0, cell);
    for (std::uint32_t p = scene.levels.cell_start[slot]; p < scene.levels.cell_start[slot + 1]; ++p)
        transfer::record({p, crack}, scene.particles);
}

Real linear(std::size_t component, const Vec3& x)
{
    return static_cast<Real>(component + 1) + 2 * x[0] - x[1] + 0.5 * x[2];
}
} // namespace

// The mean of a linear field is its value at the centre; that of |x - c|^2 is R^2 / 3 with the weight (1 - r^2/R^2)^2.
TEST(Nonlocal, mean_is_that_of_the_weight)
{
    Scene scene = block({}, everything);
    const Vec3 centre = scene.levels.origin + Vec3(0.25, 0.25, -0.25);
    put_stress([&](std::size_t n, const Vec3& x) { return linear(n, x - centre); }, scene);
    const transfer::Ball ball = ball_at(scene, 0, {0, 0, -1}, 1.1);
    for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(mean_of(scene, ball).s[n], static_cast<Real>(n + 1), 1e-12);
    put_stress([&](std::size_t, const Vec3& x) { return (x - centre).squaredNorm(); }, scene);
    EXPECT_NEAR(mean_of(scene, ball).s[0] / (1.1 * 1.1 / 3), 1, 0.01);
}

TEST(Nonlocal, what_does_not_count_is_left_out_of_the_mean_and_of_its_weight)
{
    Scene scene = block({}, everything);
    const Real centre = scene.levels.origin[0];
    put_stress([&](std::size_t, const Vec3& x) { return x[0] > centre ? 3 : 100; }, scene);
    const transfer::Ball ball = ball_at(scene, 0, {0, 0, 0}, 1.1);
    const auto right = [&](std::uint32_t p) { return scene.particles.rest_position[0][p] > centre; };
    EXPECT_NEAR(mean_of(scene, ball, right).s[0], 3, 1e-12);
    EXPECT_GT(mean_of(scene, ball).s[0], 4);
    EXPECT_EQ(mean_of(scene, ball, [](std::uint32_t) { return false; }).s[0], 0);
}

TEST(Nonlocal, is_tested_before_a_wave_crosses_more_than_the_radius)
{
    transfer::LawTable laws;
    laws.constants.resize(2);
    laws.constants[0].wave_speed = 1;
    laws.constants[1].wave_speed = 2;
    laws.nonlocal_radius = 1;
    EXPECT_EQ(transfer::nonlocal_interval(laws, 0.049), 10);
    EXPECT_EQ(transfer::nonlocal_interval(laws, 0.51), 1);
    EXPECT_EQ(transfer::nonlocal_interval(laws, 10), 1);
}

TEST(Nonlocal, levels_do_not_matter)
{
    for (const std::size_t topology : {1U, 2U, 3U}) {
        Scene scene =
            support::scene_of(support::topologies()[topology], {}, {support::soft_elastic()}, support::Layout::regular);
        int tested = 0;
        for (const grid::CellKey& key : support::topologies()[topology].cells) {
            const Real spacing = scene.levels.spacing(key.level);
            const Vec3 local = spacing * (key.cell.cast<Real>() + Vec3::Constant(0.5));
            if (local.cwiseAbs().maxCoeff() > 0.5) continue; // the ball stays inside
            const Vec3 centre = scene.levels.origin + local;
            const transfer::Ball ball = ball_at(scene, key.level, key.cell, 0.9);
            put_stress([&](std::size_t n, const Vec3& x) { return linear(n, x - centre); }, scene);
            EXPECT_NEAR(mean_of(scene, ball).s[0], 1, 0.04); // 2 % of what the field changes over R
            put_stress([&](std::size_t, const Vec3& x) { return (x - centre).squaredNorm(); }, scene);
            EXPECT_NEAR(mean_of(scene, ball).s[0] / (0.9 * 0.9 / 3), 1, 0.05);
            ++tested;
        }
        EXPECT_GT(tested, 20);
    }
}

namespace
{
/// A block, its half above z = 0 and its quarter below x = 0.5 as well. The stress is symmetric about both planes: what
/// changes its sign in a mirror is odd there.
struct Mirrored
{
    Scene whole = block({}, everything);
    Scene half = block({{2, 0}}, [](const Index3& cell) { return cell[2] >= 0; });
    Scene quarter = block({{2, 0}, {0, 1}}, [](const Index3& cell) { return cell[2] >= 0 && cell[0] < 1; });

    Mirrored()
    {
        for (Scene* scene : {&whole, &half, &quarter})
            put_stress(
                [origin = scene->levels.origin](std::size_t n, const Vec3& at) {
                    const Vec3 x = at - origin - Vec3(0.5, 0, 0);
                    const Real even = 1 + x[0] * x[0] + x[2] * x[2] + x[1];
                    const Real odd[6] = {1, 1, 1, x[0], x[2], x[2] * x[0]};
                    return even * odd[n];
                },
                *scene);
    }
};

/// `ball(scene)` is as large, with the same mean, whatever part of the block there is.
template <class BallOf>
void expect_same_in_part(const Mirrored& model, const BallOf& ball)
{
    const core::Sym<Real> expected = mean_of(model.whole, ball(model.whole));
    for (const Scene* part : {&model.half, &model.quarter}) {
        EXPECT_EQ(ball(*part).particle.size(), ball(model.whole).particle.size());
        const core::Sym<Real> mean = mean_of(*part, ball(*part));
        for (std::size_t n = 0; n < 6; ++n) {
            EXPECT_GT(std::abs(expected.s[n]), 0.01);
            EXPECT_NEAR(mean.s[n], expected.s[n], 1e-12);
        }
    }
}
} // namespace

TEST(Nonlocal, a_symmetry_plane_cuts_nothing_off)
{
    expect_same_in_part({}, [](const Scene& scene) { return ball_at(scene, 0, {0, 0, 0}, 0.9); });
}

TEST(Nonlocal, a_symmetry_plane_does_not_end_the_metal_ahead_of_a_crack)
{
    for (const Vec3& way : {Vec3(0.5, -0.5, -1), Vec3(1, 0.5, 0.5), Vec3(1, 0, -1)})
        expect_same_in_part({}, [&](const Scene& scene) { return ball_ahead(scene, way.normalized(), 1.1); });
}

// A slab one cell thick between two symmetry planes is plane strain: mirrors see each other.
TEST(Nonlocal, a_slab_between_two_symmetry_planes_has_no_end)
{
    Scene whole = block({}, everything);
    Scene slab = block({{2, 0}, {2, 1}}, [](const Index3& cell) { return cell[2] == 0; });
    for (Scene* scene : {&whole, &slab})
        put_stress([&](std::size_t n, const Vec3& x) { return n > 3 ? 0 : linear(n, {x[0], x[1], 0}); }, *scene);
    const transfer::Ball all = ball_at(whole, 0, {-1, 0, 0}, 1.2), thin = ball_at(slab, 0, {-1, 0, 0}, 1.2);
    EXPECT_EQ(all.particle.size(), thin.particle.size());
    for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(mean_of(slab, thin).s[n], mean_of(whole, all).s[n], 1e-12);
}

TEST(Nonlocal, other_materials_do_not_count)
{
    Scene scene = block({}, everything);
    put_stress([](std::size_t, const Vec3&) { return 1; }, scene);
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        if (scene.particles.rest_position[0][p] < scene.levels.origin[0]) continue;
        scene.particles.material[p] = 1;
        scene.particles.stress[0][p] = 100;
    }
    EXPECT_NEAR(mean_of(scene, ball_at(scene, 0, {-1, 0, 0}, 0.9, 0)).s[0], 1, 1e-12);
    EXPECT_NEAR(mean_of(scene, ball_at(scene, 0, {0, 0, 0}, 0.9, 1)).s[0], 100, 1e-10);
}

TEST(Nonlocal, a_ball_smaller_than_the_distance_of_particles_is_the_cell)
{
    Scene scene = block({}, everything);
    const transfer::Ball ball = ball_at(scene, 0, {0, 0, 0}, 0.01);
    EXPECT_EQ(ball.particle.size(), 8U);
    for (const Real weight : ball.weight) EXPECT_NEAR(weight, scene.particles.rest_volume[0], 1e-15);
}

namespace
{
constexpr Real cell_alone = 0.01; // mm, radius: the cell itself decides

/// Shear strength 1 MPa, no tensile one.
/// @param radius  mm, of the nonlocal onset
material::Material fails_in_shear(Real radius)
{
    material::Material metal = support::soft_elastic();
    metal.decohesion.emplace();
    metal.decohesion->s_max = std::numeric_limits<Real>::infinity();
    metal.decohesion->tau_max = 1;
    metal.decohesion->energy_2 = 1;
    metal.decohesion->nonlocal_radius = radius;
    return metal;
}

/// Particles that start.
std::size_t start(Scene& scene)
{
    transfer::Lattice none;
    transfer::NonlocalTable table;
    return transfer::start_nonlocal_cracks(scene.options, scene.laws, scene.levels, none, scene.particles, table);
}

/// A cell with a crack across y.
struct CrackedCell
{
    Index3 cell;
    Real damage = 1; // 1
    Real stress = 0; // MPa, shear on its plane
};

/// Particles that start where a row of cells along x, the first of them cell 0, carries shear beyond the strength of 1
/// MPa, all around it a fifth.
/// @param load  MPa
std::size_t started(Real radius, const std::optional<CrackedCell>& cracked, Real load = 1.2, int row = 1)
{
    material::Material metal = fails_in_shear(radius);
    metal.decohesion->crack_exclusion = 1.1;
    Scene scene = block({}, everything, metal);
    const auto cell_of = [&](std::size_t p) {
        return Index3(((support::vector_of(scene.particles.rest_position, p) - scene.levels.origin) / 0.5)
                          .array()
                          .floor()
                          .cast<int>());
    };
    put_stress([](std::size_t n, const Vec3&) { return n == 3 ? 0.2 : 0.0; }, scene);
    for (std::size_t p = 0; p < scene.particles.size(); ++p) {
        const Index3 cell = cell_of(p);
        if (cell[0] >= 0 && cell[0] < row && cell[1] == 0 && cell[2] == 0) scene.particles.stress[3][p] = load;
        if (cracked && cell == cracked->cell) scene.particles.stress[3][p] = cracked->stress;
    }
    if (cracked) {
        core::Crack crack = through_crack();
        crack.damage = cracked->damage;
        put_crack(cracked->cell, crack, scene);
    }
    return start(scene);
}
} // namespace

// The mean of the ball never starts the loaded cell. A crack that arrives does, if what it would cut next is loaded as
// well; flanks do not count. One that passes beside it does not.
TEST(Nonlocal, where_a_crack_arrives_the_metal_ahead_decides)
{
    const auto started = [](const std::optional<Index3>& cracked, int row) {
        return ::started(1.1, cracked ? std::optional(CrackedCell{*cracked}) : std::nullopt, 1.2, row);
    };
    EXPECT_EQ(started({}, 2), 0U);
    EXPECT_EQ(started(Index3(-1, 0, 0), 2), 8U);  // straight on
    EXPECT_EQ(started(Index3(-1, 0, 0), 1), 0U);  // into metal that carries little
    EXPECT_EQ(started(Index3(-1, -1, 0), 2), 8U); // a kink
    EXPECT_EQ(started(Index3(0, -1, 0), 2), 0U);  // at its flank
    EXPECT_EQ(started(Index3(-2, 0, 0), 2), 0U);  // not there yet
}

TEST(Nonlocal, metal_ahead_of_a_crack_is_as_long_whatever_the_cells)
{
    const Scene scene = block({}, everything); // cells of 0.5 mm, particles at their quarters
    const auto ahead = [&](const Vec3& way, Real length) { return ball_ahead(scene, way, length); };
    EXPECT_EQ(ahead({1, 0, 0}, 0.5).particle.size(), 8U);
    EXPECT_EQ(ahead({1, 0, 0}, 0.75).particle.size(), 12U);
    EXPECT_EQ(ahead({1, 0, 0}, 1.1).particle.size(), 16U);
    EXPECT_EQ(ahead({0, -1, 0}, 1.5).particle.size(), 24U);
    const transfer::Ball ball = ahead({1, 0, 0}, 1.1);
    for (const std::uint32_t p : ball.particle) {
        const Vec3 place = support::vector_of(scene.particles.rest_position, p) - scene.levels.origin;
        EXPECT_TRUE(place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 0.5 && place[2] > 0 && place[2] < 0.5);
    }
    EXPECT_EQ(ahead(Vec3(1, 1, 0).normalized(), 1.1).particle.size(), 18U);
}

// Cracks beyond a symmetry plane are the images of those before it.
TEST(Nonlocal, a_symmetry_plane_hides_no_cracks)
{
    Mirrored model;
    const auto put_cracks = [](int z, Scene& scene) {
        core::Crack crack = through_crack();
        const Vec3 normal = Vec3(0.1, 0.9, z < 0 ? -0.3 : 0.3).normalized();
        crack.normal = {normal[0], normal[1], normal[2]};
        put_crack({1, 0, z}, crack, scene);
        put_crack({0, 2, z}, crack, scene); // not beside the cell
    };
    put_cracks(0, model.half);
    put_cracks(0, model.whole);
    put_cracks(-1, model.whole);
    const transfer::Lattice none;
    const transfer::NonlocalTable table;
    const auto expect_same = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        EXPECT_TRUE(a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin(), [](auto& x, auto& y) {
                        return (x - y).norm() < 1e-12;
                    }));
    };
    std::vector<Vec3> offsets[2], normals[2], ways[2];
    for (const bool halved : {false, true}) {
        const Scene& scene = halved ? model.half : model.whole;
        const transfer::NonlocalView view{scene.options, scene.laws, scene.levels, none, table};
        const std::size_t slot = slot_at(scene, 0, {0, 0, 0});
        for (const transfer::Neighbour& other : transfer::cracks_near(view, scene.particles, slot, 1.1)) {
            offsets[halved].push_back(other.offset);
            normals[halved].emplace_back(other.normal[0], other.normal[1], other.normal[2]);
        }
        ways[halved] = transfer::arriving_cracks(view, scene.particles, slot);
    }
    EXPECT_EQ(offsets[0].size(), 4U);
    EXPECT_EQ(ways[0].size(), 2U);
    expect_same(offsets[0], offsets[1]);
    expect_same(normals[0], normals[1]);
    expect_same(ways[0], ways[1]); // in the planes of the cracks
}

// A crack beside the loaded cell forbids another one while it carries what is left of its strength.
TEST(Nonlocal, only_a_crack_that_softens_forbids_others)
{
    const Index3 beside(0, -1, 0);
    EXPECT_EQ(started(cell_alone, {}), 8U);
    EXPECT_EQ(started(cell_alone, CrackedCell{beside, 0.2, 0.8}), 0U);
    EXPECT_EQ(started(cell_alone, CrackedCell{beside, 0.2, 0.3}), 8U); // unloaded
    EXPECT_EQ(started(cell_alone, CrackedCell{beside, 1, 0}), 8U);     // through
}

// A cell beyond one and a quarter of the strength starts alone, and beside a crack that softens.
TEST(Nonlocal, an_overloaded_cell_is_not_held_back)
{
    const CrackedCell beside{Index3(0, -1, 0), 0.2, 0.8};
    EXPECT_EQ(started(1.1, {}, 1.2), 0U);
    EXPECT_EQ(started(1.1, {}, 1.3), 8U);
    EXPECT_EQ(started(1.1, beside, 1.2), 0U);
    EXPECT_EQ(started(1.1, beside, 1.3), 8U);
}

namespace
{
/// Particles that start where the plane across y is weak, 1 MPa, and carries that much in one cell, a fifth in the
/// others; along x there are 3 MPa, which no weak plane sees.
std::size_t started_on_weak_plane(Real load)
{
    material::Material metal = fails_in_shear(1.1);
    std::swap(metal.decohesion->s_max, metal.decohesion->tau_max);
    metal.decohesion->weak_plane = {0, 1, 0};
    Scene scene = block({}, everything, metal);
    const Vec3 middle = scene.levels.origin + Vec3::Constant(0.25);
    put_stress(
        [&](std::size_t n, const Vec3& x) {
            const bool inside = (x - middle).cwiseAbs().maxCoeff() < 0.25;
            return n == 0 ? 3 : n == 1 ? (inside ? load : 0.2) : 0;
        },
        scene);
    return start(scene);
}
} // namespace

// Stress along the plane neither overloads a cell, so that it goes before its ball, nor adds to the ball's.
TEST(Nonlocal, a_weak_plane_is_tested_on_its_own_traction)
{
    EXPECT_EQ(started_on_weak_plane(0.9), 0U);
    EXPECT_EQ(started_on_weak_plane(1.1), 0U);
    EXPECT_EQ(started_on_weak_plane(1.3), 8U); // beyond one and a quarter
}

namespace
{
/// Particles of one cell that start in shear between the strengths of shear, 1 MPa, and of a tension bar, 1.5 MPa,
/// after tension just below the latter.
/// @param strain  1, plastic strain that comes with the shear
/// @param memory  1, lode_memory
std::size_t started_after_tension(Real strain, Real memory)
{
    material::Material metal = fails_in_shear(cell_alone);
    metal.decohesion->tau_max_axial = 1.5;
    metal.decohesion->lode_memory = memory;
    support::Topology topology = support::topology_of("cell", 1, 3, [](const grid::CellKey&) { return false; });
    std::erase_if(topology.cells, [](const grid::CellKey& key) { return key.cell != Index3::Zero(); });
    Scene scene = support::scene_of(topology, {}, {metal}, support::Layout::regular);
    scene.particles.lode_mean.assign(scene.particles.size(), 0);
    scene.particles.lode_strain.assign(scene.particles.size(), -1);
    std::fill(scene.particles.eq_plastic_strain.begin(), scene.particles.eq_plastic_strain.end(), 0.3);
    put_stress([](std::size_t n, const Vec3&) { return n == 0 ? 2.9 : 0.0; }, scene);
    EXPECT_EQ(start(scene), 0U);
    for (Real& strained : scene.particles.eq_plastic_strain) strained += strain;
    put_stress([](std::size_t n, const Vec3&) { return n == 3 ? 1.2 : 0.0; }, scene);
    return start(scene);
}
} // namespace

// A wave that turns the stress of metal strained like a tension bar starts nothing; straining it that way does.
TEST(Nonlocal, the_strength_of_a_state_is_remembered_over_plastic_strain)
{
    EXPECT_EQ(started_after_tension(0, 0), 8U);
    EXPECT_EQ(started_after_tension(0, 0.05), 0U);
    // 1 + 0.5 L_m^2 < 1.2 below |L_m| = 0.632 = exp(-0.458)
    EXPECT_EQ(started_after_tension(0.450 * 0.05, 0.05), 0U);
    EXPECT_EQ(started_after_tension(0.465 * 0.05, 0.05), 8U);
}

// One layer of cells: planes beside a crack are forbidden, those that continue or cross it are not. Cells of 1 mm.
TEST(Nonlocal, cracks_beside_a_crack_are_excluded)
{
    const Vec3 y(0, 1, 0), tilted = Vec3(-1, 1, 0).normalized(), x(1, 0, 0);
    const Real diagonal = std::sqrt(2);
    EXPECT_TRUE(transfer::excluded({0, 1, 0}, y, y, 1, 2.5));
    EXPECT_TRUE(transfer::excluded({0, -2, 0}, y, y, 1, 2.5));
    EXPECT_FALSE(transfer::excluded({0, 3, 0}, y, y, 1, 2.5)); // far enough
    EXPECT_FALSE(transfer::excluded({1, 0, 0}, y, y, 1, 2.5)); // straight on
    EXPECT_FALSE(transfer::excluded({1, 1, 0}, y, y, 1, 2.5)); // kinks
    EXPECT_FALSE(transfer::excluded({0, 1, 0}, y, x, 1, 2.5)); // meets it
    EXPECT_FALSE(transfer::excluded({1, 1, 0}, tilted, tilted, diagonal, 2.5));
    EXPECT_FALSE(transfer::excluded({1, 0, 0}, tilted, tilted, diagonal, 2.5)); // the stairs of an inclined layer
    EXPECT_TRUE(transfer::excluded({1, -1, 0}, tilted, tilted, diagonal, 2.5));
    EXPECT_FALSE(transfer::excluded({0, 1, 0}, y, y, 1, 0)); // switched off
}
