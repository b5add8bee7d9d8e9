// What splitting a particle into eight keeps (methods.md A.4, 14), and what the children are.
#include "particles/split.h"

#include "particles/seed.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

using particles::Particles;

namespace
{
constexpr Real spacing = 0.5;
constexpr int per_axis = 2;

/// 3^3 cells of 2^3 particles in a random state; updated formulation, with or without affine matrices.
Particles random_block(bool affine)
{
    Particles block;
    for (int c = 0; c < 27; ++c)
        particles::seed_cell(geometry::box({-9, -9, -9}, {9, 9, 9}), {1.5, Vec3::Zero(), 0, {}},
                             spacing * Vec3(c / 9, c / 3 % 3, c % 3), spacing, per_axis, 0, block);
    const std::size_t count = block.size();
    block.volume_ratio.assign(count, 0);
    if (affine)
        for (particles::Column& entry : block.affine) entry.assign(count, 0);
    support::Random random(1);
    const auto fill = [&](particles::Column& column, Real lower, Real upper) {
        for (Real& entry : column) entry = random.between(lower, upper);
    };
    for (particles::Column& column : block.velocity) fill(column, -1, 1);
    for (particles::Column& column : block.stress) fill(column, -5, 5);
    for (particles::Column& column : block.affine) fill(column, -2, 2);
    fill(block.volume_ratio, 0.9, 1.1);
    fill(block.eq_plastic_strain, 0, 0.2);
    fill(block.mass, 0.01, 0.02);
    fill(block.rest_volume, 0.01, 0.02);
    return block;
}

Particles every_second_split(const Particles& block)
{
    Particles after = block;
    std::vector<std::uint32_t> parents;
    for (std::uint32_t p = 0; p < block.size(); p += 2) parents.push_back(p);
    EXPECT_EQ(particles::split(parents, spacing, per_axis, after), parents.size());
    EXPECT_EQ(after.size(), block.size() + 7 * parents.size());
    return after;
}

Vec3 vector_of(const std::array<particles::Column, 3>& columns, std::size_t p)
{
    return {columns[0][p], columns[1][p], columns[2][p]};
}

/// Every sum over particles that must not change, whatever the transfer.
using Sums = Eigen::Matrix<Real, 14, 1>;

Sums sums_of(const Particles& block)
{
    Sums sums = Sums::Zero();
    for (std::size_t p = 0; p < block.size(); ++p) {
        const Real m = block.mass[p], volume = block.rest_volume[p];
        sums[0] += m;
        sums[1] += volume;
        sums[2] += volume * block.volume_ratio[p];
        sums[3] += m * block.eq_plastic_strain[p];
        sums.segment<3>(4) += m * vector_of(block.position, p);
        sums.segment<3>(7) += m * vector_of(block.rest_position, p);
        sums.segment<3>(10) += m * vector_of(block.velocity, p);
        for (const particles::Column& component : block.stress)
            sums[13] += volume * component[p] * component[p]; // stands for any energy of the stress
    }
    return sums;
}

/// sum m [x x v + e : (D C^T)] on the unchanged grid: D = diag(xi (1 - xi) h^2) of a point in its cell.
Vec3 angular_momentum(const Particles& block)
{
    Vec3 total = Vec3::Zero();
    for (std::size_t p = 0; p < block.size(); ++p) {
        const Vec3 x = vector_of(block.position, p);
        total += block.mass[p] * x.cross(vector_of(block.velocity, p));
        if (block.affine[0].empty()) continue;
        const Vec3 xi = (x / spacing).array() - (x / spacing).array().floor();
        const Vec3 d = spacing * spacing * xi.array() * (1 - xi.array());
        const auto moment = [&](std::size_t a, std::size_t b) {
            return block.affine[3 * a + b][p] * d[static_cast<int>(b)];
        };
        total +=
            block.mass[p] * Vec3(moment(2, 1) - moment(1, 2), moment(0, 2) - moment(2, 0), moment(1, 0) - moment(0, 1));
    }
    return total;
}

Real kinetic_energy(const Particles& block)
{
    Real energy = 0;
    for (std::size_t p = 0; p < block.size(); ++p)
        energy += block.mass[p] * vector_of(block.velocity, p).squaredNorm() / 2;
    return energy;
}
} // namespace

TEST(Split, keeps_mass_volume_momentum_plastic_strain_and_centres)
{
    for (const bool affine : {false, true}) {
        const Particles block = random_block(affine);
        const Sums before = sums_of(block), after = sums_of(every_second_split(block));
        EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
    }
}

TEST(Split, keeps_angular_momentum)
{
    for (const bool affine : {false, true}) {
        const Particles block = random_block(affine);
        const Vec3 before = angular_momentum(block);
        EXPECT_LT((angular_momentum(every_second_split(block)) - before).norm(), 1e-12 * before.norm());
    }
}

// FLIP children move like their parent. An affine parent carries energy in C that its velocity does not show; the
// children's velocities show it: m |C|^2 l^2 / 16 per direction, l / 4 from the parent's place.
TEST(Split, keeps_kinetic_energy_but_for_the_affine_part)
{
    const Particles flip = random_block(false);
    EXPECT_NEAR(kinetic_energy(every_second_split(flip)) / kinetic_energy(flip), 1, 1e-13);

    const Particles apic = random_block(true);
    const Real side = spacing / per_axis;
    Real expected = kinetic_energy(apic);
    for (std::size_t p = 0; p < apic.size(); p += 2)
        for (const particles::Column& entry : apic.affine)
            expected += apic.mass[p] / 2 * entry[p] * entry[p] * side * side / 16;
    EXPECT_NEAR(kinetic_energy(every_second_split(apic)) / expected, 1, 1e-13);
}

TEST(Split, children_tile_the_parent_and_copy_its_state)
{
    const Particles block = random_block(true);
    Particles after = block;
    const std::uint32_t parent = 5;
    ASSERT_EQ(particles::split(std::vector<std::uint32_t>{parent}, spacing, per_axis, after), 1U);
    std::vector<std::size_t> children{parent};
    for (std::size_t p = block.size(); p < after.size(); ++p) children.push_back(p);
    ASSERT_EQ(children.size(), 8U);
    const Real quarter = spacing / per_axis / 4;
    std::set<std::array<int, 3>> sides;
    for (const std::size_t c : children) {
        const Vec3 offset = vector_of(after.position, c) - vector_of(block.position, parent);
        EXPECT_LT((vector_of(after.rest_position, c) - vector_of(block.rest_position, parent) - offset).norm(), 1e-15);
        for (int a = 0; a < 3; ++a) EXPECT_NEAR(std::abs(offset[a]), quarter, 1e-15);
        sides.insert({offset[0] > 0, offset[1] > 0, offset[2] > 0});
        EXPECT_EQ(after.size_level[c], block.size_level[parent] + 1);
        EXPECT_EQ(after.target_level[c], block.target_level[parent]);
        EXPECT_EQ(after.eq_plastic_strain[c], block.eq_plastic_strain[parent]);
        for (std::size_t n = 0; n < 6; ++n) EXPECT_EQ(after.stress[n][c], block.stress[n][parent]);
        for (std::size_t n = 0; n < 9; ++n) EXPECT_EQ(after.affine[n][c], block.affine[n][parent]);
        Vec3 velocity = vector_of(block.velocity, parent);
        for (std::size_t n = 0; n < 9; ++n)
            velocity[static_cast<int>(n / 3)] += block.affine[n][parent] * offset[static_cast<int>(n % 3)];
        EXPECT_LT((vector_of(after.velocity, c) - velocity).norm(), 1e-14);
    }
    EXPECT_EQ(sides.size(), 8U);
    EXPECT_EQ(after.id[parent], block.id[parent]);
    EXPECT_EQ(std::set<std::uint32_t>(after.id.begin(), after.id.end()).size(), after.size());
}

TEST(Split, leaves_separating_particles_alone)
{
    Particles block = random_block(false);
    block.crack[4] = 0;
    block.cracks.emplace_back();
    const Particles before = block;
    EXPECT_EQ(particles::split(std::vector<std::uint32_t>{4}, spacing, per_axis, block), 0U);
    EXPECT_EQ(block.size(), before.size());
    EXPECT_EQ(block.mass, before.mass);
}
