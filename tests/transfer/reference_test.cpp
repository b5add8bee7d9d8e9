// The sparse SIMD passes against the dense reference of tests/support/dense_mpm.h, every variant.
#include "tests/support/dense_mpm.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

using support::DenseMpm;
using support::Scene;
using transfer::Basis;
using transfer::Formulation;
using transfer::StressUpdate;
using transfer::Transfer;

namespace
{
DenseMpm dense_of(const Scene& scene)
{
    DenseMpm dense;
    dense.spacing = scene.levels.spacing(scene.levels.count - 1);
    dense.origin = scene.levels.origin;
    dense.options = scene.options;
    dense.materials = scene.laws.materials;
    const particles::Particles& particles = scene.particles;
    dense.points.resize(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p) {
        support::DensePoint& point = dense.points[particles.id[p]];
        point.position = support::vector_of(particles.position, p);
        point.rest_position = support::vector_of(particles.rest_position, p);
        point.velocity = support::vector_of(particles.velocity, p);
        point.stress = support::stress_of(particles, p);
        if (scene.options.transfer == Transfer::apic) point.affine = support::matrix_of(particles.affine, p);
        if (scene.options.formulation == Formulation::total)
            point.deformation_gradient = support::matrix_of(particles.deformation_gradient, p);
        point.rest_volume = particles.rest_volume[p];
        point.mass = particles.mass[p];
        point.material = particles.material[p];
    }
    return dense;
}

/// Largest difference of velocity, position (over dt), stress and plastic strain, relative to their size.
Real difference(const Scene& scene, const DenseMpm& dense)
{
    Vec3 apart = Vec3::Zero(), size = Vec3::Zero();
    Real strain = 0;
    const particles::Particles& particles = scene.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const support::DensePoint& point = dense.points[particles.id[p]];
        const auto compare = [&](int n, Real difference, Real value) {
            apart[n] = std::max(apart[n], difference);
            size[n] = std::max(size[n], value);
        };
        compare(0, (support::vector_of(particles.velocity, p) - point.velocity).norm(), point.velocity.norm());
        compare(1, (support::vector_of(particles.position, p) - point.position).norm(), dense.spacing);
        compare(2, (support::stress_of(particles, p) - point.stress).norm(), point.stress.norm());
        strain = std::max(strain, std::abs(particles.eq_plastic_strain[p] - point.eq_plastic_strain));
    }
    return std::max(apart.cwiseQuotient(size).maxCoeff(), strain);
}

struct Variant
{
    Formulation formulation;
    Transfer transfer;
    StressUpdate stress_update;
    Basis basis;
};

std::vector<Variant> variants()
{
    std::vector<Variant> all;
    for (const Formulation f : {Formulation::updated, Formulation::total})
        for (const Transfer t : {Transfer::flip, Transfer::apic})
            for (const StressUpdate s : {StressUpdate::usl, StressUpdate::musl})
                for (const Basis b : {Basis::trilinear, Basis::gimp}) all.push_back({f, t, s, b});
    return all;
}

transfer::PassOptions options_of(const Variant& variant)
{
    transfer::PassOptions options;
    options.formulation = variant.formulation;
    options.transfer = variant.transfer;
    options.stress_update = variant.stress_update;
    options.basis = variant.basis;
    return options;
}

std::string name_of(const Variant& v)
{
    return std::string(v.formulation == Formulation::total ? "total" : "updated") +
           (v.transfer == Transfer::apic ? " apic" : " flip") +
           (v.stress_update == StressUpdate::musl ? " musl" : " usl") + (v.basis == Basis::gimp ? " gimp" : "");
}

/// Cells of 1 to 20 particles of two materials in a random state, drifting along the diagonal.
Scene busy_scene(const Variant& variant, bool averaged, Real drift)
{
    Scene scene = support::scene_of(support::topologies().front(), options_of(variant),
                                    support::two_metals(1, averaged), support::Layout::random, 21);
    support::randomise_state(22, scene);
    for (particles::Column& column : scene.particles.velocity)
        for (std::size_t p = 0; p < column.size(); ++p) column[p] += drift;
    transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
    return scene;
}
} // namespace

TEST(Reference, every_variant_agrees_over_twenty_steps_while_particles_change_cells)
{
    for (const Variant& variant : variants()) {
        Scene scene = busy_scene(variant, false, 100);
        DenseMpm dense = dense_of(scene);
        std::size_t strays = 0;
        for (int n = 0; n < 20; ++n) {
            support::advance(1e-5, scene);
            dense.step(1e-5);
            strays = std::max(strays, scene.strays.size());
        }
        EXPECT_LT(difference(scene, dense), 1e-11) << name_of(variant);
        EXPECT_EQ(strays > 0, variant.formulation == Formulation::updated) << name_of(variant);
        EXPECT_GT(dense.plastic_work, 0) << name_of(variant);
        EXPECT_NEAR(scene.plastic_work / dense.plastic_work, 1, 1e-11) << name_of(variant);
    }
}

TEST(Reference, averaged_dilatation_agrees_while_nobody_changes_cells)
{
    for (const Variant& variant : variants()) {
        Scene scene = busy_scene(variant, true, 0);
        // Far enough from the faces of the cell for twenty steps.
        for (std::size_t p = 0; p < scene.particles.size(); ++p)
            for (std::size_t a = 0; a < 3; ++a) {
                const Real h = scene.levels.spacing0;
                const Real o = scene.levels.origin[static_cast<int>(a)];
                const Real centre = o + h * (std::floor((scene.particles.position[a][p] - o) / h) + 0.5);
                scene.particles.position[a][p] = centre + 0.9 * (scene.particles.position[a][p] - centre);
                scene.particles.rest_position[a][p] = scene.particles.position[a][p];
            }
        support::order(scene);
        DenseMpm dense = dense_of(scene);
        for (int n = 0; n < 20; ++n) {
            support::advance(1e-5, scene);
            dense.step(1e-5);
        }
        EXPECT_EQ(scene.strays.size(), 0U) << name_of(variant);
        EXPECT_LT(difference(scene, dense), 1e-11) << name_of(variant);
    }
}

TEST(Reference, what_has_lost_half_of_its_volume_leaves_the_mean_dilatation)
{
    for (const Variant& variant : variants()) {
        if (variant.formulation == Formulation::updated || variant.basis == Basis::gimp) continue;
        Scene scene = busy_scene(variant, true, 0);
        for (const std::size_t n : {0U, 4U, 8U})
            for (std::size_t p = 0; p < scene.particles.size(); p += 5)
                scene.particles.deformation_gradient[n][p] = 0.7; // J = 0.34
        transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
        DenseMpm dense = dense_of(scene);
        for (int n = 0; n < 20; ++n) {
            support::advance(1e-5, scene);
            dense.step(1e-5);
        }
        EXPECT_LT(difference(scene, dense), 1e-11) << name_of(variant);
    }
}

TEST(Reference, cells_of_one_to_seventy_particles_agree)
{
    // One cell of each count; 70 needs more than one group of lanes that are averaged together.
    for (const Variant& variant : variants())
        for (const int count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 64, 70}) {
            support::Topology cell{"one cell", grid::Refinement(1), {{0, Index3(7, -1, 0)}}};
            Scene scene =
                support::scene_of(cell, options_of(variant), support::two_metals(1, false), support::Layout::random, 1);
            support::Random random(static_cast<std::uint64_t>(count));
            const auto resize = [&](const auto&, auto& column) {
                if (!column.empty()) column.assign(static_cast<std::size_t>(count), column.front());
            };
            particles::Particles::for_each_real(scene.particles, resize);
            particles::Particles::for_each_integer(scene.particles, resize);
            for (std::uint32_t p = 0; p < scene.particles.size(); ++p) {
                scene.particles.id[p] = p;
                scene.particles.material[p] = static_cast<std::uint8_t>(random.whole(0, 1));
                const Vec3 x = scene.levels.origin + 0.5 * (Vec3(7, -1, 0) + random.vector(0.1, 0.9));
                for (std::size_t a = 0; a < 3; ++a)
                    scene.particles.position[a][p] = scene.particles.rest_position[a][p] = x[static_cast<int>(a)];
            }
            support::randomise_state(23, scene);
            support::order(scene);
            DenseMpm dense = dense_of(scene);
            for (int n = 0; n < 3; ++n) {
                support::advance(1e-5, scene);
                dense.step(1e-5);
            }
            EXPECT_LT(difference(scene, dense), 1e-11) << name_of(variant) << ", " << count << " particles";
        }
}

TEST(Reference, a_share_of_pic_agrees)
{
    for (Variant variant : variants()) {
        variant.transfer = Transfer::flip;
        Scene scene = busy_scene(variant, false, 100);
        scene.options.pic_fraction = 0.25;
        DenseMpm dense = dense_of(scene);
        for (int n = 0; n < 5; ++n) {
            support::advance(1e-5, scene);
            dense.step(1e-5);
        }
        EXPECT_LT(difference(scene, dense), 1e-11) << name_of(variant);
    }
}
