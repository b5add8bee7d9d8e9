/// Separated particles eight at a time (transfer/slide_batch.h) against separate_particle, one by one.
#include "transfer/slide_batch.h"

#include "tests/support/random.h"
#include "transfer/set_aside.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using support::Random;
using transfer::SeparationInput;

namespace
{
/// A plastic material with friction and an elastic one without.
transfer::LawTable laws()
{
    material::Material rough;
    rough.elastic = {1e-3, 1000, 0.3};
    rough.plastic = material::VonMises{10, 50};
    rough.decohesion = material::Decohesion{};
    rough.decohesion->s_max = 12;
    rough.decohesion->tau_max = 8;
    rough.decohesion->tau_max_axial = 11;
    rough.decohesion->u0 = 1e-3;
    rough.decohesion->friction = 0.4;
    rough.decohesion->second_crack = true;
    material::Material smooth = rough;
    smooth.elastic = {3e-3, 2500, 0.2};
    smooth.plastic.reset();
    smooth.decohesion->friction = 0;
    return transfer::law_table({rough, smooth});
}

struct Particle
{
    core::Mat<Real> gradient, deformation;
    core::Crack crack;
    SeparationInput input;
};

/// What may happen to a separated particle.
enum class Fate
{
    slides,   // any motion
    closes,   // the faces meet within the step
    stays,    // no motion at all
    inverted, // J < 0 at the end of the step
    squeezed, // thinner than the time step can follow
    crushed,  // J below the smallest ratio in the middle of the step
};
constexpr int fates = 6;

core::Vec<Real> vector(Random& random, Real size)
{
    const Real x = random.between(-size, size), y = random.between(-size, size), z = random.between(-size, size);
    return {{x, y, z}};
}

core::Mat<Real> near_identity(Random& random, Real size)
{
    core::Mat<Real> m = core::identity<Real>();
    for (Real& entry : m.m) entry += random.between(-size, size);
    return m;
}

Particle particle(Fate fate, int material, const transfer::PassOptions& options, Real per_spacing, Random& random)
{
    Particle p{};
    const core::Vec<Real> normal = vector(random, 1);
    p.crack.normal = ((1 / std::sqrt(core::dot(normal, normal))) * normal).v;
    p.crack.slip = vector(random, 1e-2).v;
    p.crack.damage = 1;
    p.crack.effective_length = random.between(0.1, 0.5);
    p.crack.opening = random.whole(0, 3) == 0 ? 0 : random.between(0, 2e-3);
    p.crack.particle_id = static_cast<std::uint32_t>(random.whole(0, 1000));
    p.crack.second_time = random.whole(0, 4) == 0 ? 0.5 : -1;
    for (Real& entry : p.gradient.m) entry = fate == Fate::stays ? 0 : random.between(-0.02, 0.02);
    p.deformation = near_identity(random, 0.1);
    p.input.volume_ratio = random.between(0.8, 1.2);
    if (fate == Fate::closes) {
        p.crack.opening = random.between(0, 1e-4);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                p.gradient(i, j) -=
                    0.03 * p.crack.normal[static_cast<unsigned>(i)] * p.crack.normal[static_cast<unsigned>(j)];
    }
    if (fate == Fate::inverted)
        for (int j = 0; j < 3; ++j) p.deformation(1, j) *= -1;
    if (fate == Fate::squeezed)
        for (int j = 0; j < 3; ++j) p.deformation(2, j) *= 0.02;
    if (fate == Fate::crushed) p.input.volume_ratio = random.between(-0.5, 0.049);
    for (Real& entry : p.input.step.stress.s) entry = random.between(-15, 15);
    p.input.step.strain = core::symmetric_part(p.gradient);
    p.input.step.spin = material::spin_increment(p.gradient);
    p.input.step.eq_plastic_strain = random.between(0, 0.1);
    p.input.step.dt = options.dt;
    p.input.step.time = options.time;
    p.input.volume = random.between(1e-3, 2e-3);
    p.input.material = static_cast<std::uint8_t>(material);
    p.input.per_spacing = per_spacing;
    p.input.largest_share = random.whole(0, 1) == 0 ? transfer::unstable_step_share : transfer::deformed_step_share;
    return p;
}

template <class Numbers>
void expect_near(const Numbers& a, const Numbers& b, Real tolerance)
{
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n], b[n], tolerance);
}

void expect_same(const transfer::SetAside& together, const transfer::SeparationResult& alone)
{
    expect_near(together.result.stress.s, alone.stress.s, 1e-12 * 15);
    EXPECT_NEAR(together.result.eq_plastic_strain, alone.eq_plastic_strain, 1e-12);
    EXPECT_NEAR(together.result.plastic_work, alone.plastic_work, 1e-12 * 1e-3);
    EXPECT_NEAR(together.result.decohesion_work, alone.decohesion_work, 1e-12 * 1e-3);
}

void expect_same(const core::Crack& a, const core::Crack& b)
{
    expect_near(a.normal, b.normal, 1e-12);
    expect_near(a.slip, b.slip, 1e-12);
    EXPECT_NEAR(a.opening, b.opening, 1e-12);
    EXPECT_EQ(a.damage, b.damage);
    EXPECT_EQ(a.effective_length, b.effective_length);
    EXPECT_EQ(a.second_time, b.second_time);
    EXPECT_EQ(a.particle_id, b.particle_id);
}
/// Stress after the step of a particle in the batch, and of the same particle alone.
std::array<core::Sym<Real>, 2> stresses_both_ways(const transfer::Context& context, const Particle& p)
{
    core::Crack together = p.crack, alone = p.crack;
    transfer::SetAside aside;
    transfer::Sliders sliders;
    transfer::enlist(context, p.input, p.gradient, together, aside, sliders);
    transfer::finish(context, sliders);
    const auto result = transfer::separate_particle(context.options, context.laws, p.input, alone);
    return {aside.result.stress, result.stress};
}
} // namespace

TEST(SlideBatch, particles_together_are_the_particles_alone)
{
    const transfer::LawTable table = laws();
    const transfer::Lattice lattice;
    transfer::PassOptions options;
    options.dt = 1e-5;
    options.time = 0.3;
    const Real per_spacing = 4;
    const transfer::Context context{options, table, lattice, per_spacing, 0};
    Random random(31);
    int carried = 0, closed = 0, rubbed = 0, crossed = 0, yielded = 0;
    for (int round = 0; round < 60; ++round)
        for (int count = 1; count <= 17; ++count) {
            std::vector<Particle> particles;
            for (int i = 0; i < count; ++i) {
                const int material = round % 3 == 2 ? random.whole(0, 1) : round % 3;
                particles.push_back(
                    particle(static_cast<Fate>(random.whole(0, fates - 1)), material, options, per_spacing, random));
            }
            std::vector<Particle> alone = particles;
            std::vector<transfer::SetAside> aside(particles.size());
            transfer::Sliders sliders;
            for (std::size_t i = 0; i < particles.size(); ++i) {
                particles[i].input.deformation = &particles[i].deformation;
                transfer::enlist(context, particles[i].input, particles[i].gradient, particles[i].crack, aside[i],
                                 sliders);
            }
            transfer::finish(context, sliders);
            for (std::size_t i = 0; i < particles.size(); ++i) {
                alone[i].input.deformation = &alone[i].deformation;
                const core::Crack before = alone[i].crack;
                const transfer::SeparationResult result =
                    transfer::separate_particle(options, table, alone[i].input, alone[i].crack);
                expect_same(aside[i], result);
                expect_same(particles[i].crack, alone[i].crack);
                EXPECT_NEAR(aside[i].share, transfer::solid_share(alone[i].crack), 1e-12);
                closed += before.opening > 0 && alone[i].crack.opening <= 0 ? 1 : 0;
                rubbed += result.decohesion_work > 1e-9 ? 1 : 0;
                crossed += alone[i].crack.second_time == options.time ? 1 : 0;
                yielded += result.plastic_work > 1e-9 ? 1 : 0;
                for (const Real s : result.stress.s) carried += s != 0 ? 1 : 0;
            }
            ASSERT_FALSE(HasFailure()) << "round " << round << ", " << count << " particles";
        }
    EXPECT_GT(carried, 1000);
    EXPECT_GT(closed, 100);
    EXPECT_GT(rubbed, 100);
    EXPECT_GT(crossed, 100);
    EXPECT_GT(yielded, 100);
}

// The batch cannot tell what a lane holds, so the fates are checked one at a time.
TEST(SlideBatch, tangled_particles_carry_nothing_and_keep_their_cracks)
{
    const transfer::LawTable table = laws();
    transfer::PassOptions options;
    options.dt = 1e-5;
    Random random(32);
    for (const Fate fate : {Fate::inverted, Fate::squeezed, Fate::crushed}) {
        Particle p = particle(fate, 0, options, 4, random);
        p.input.deformation = &p.deformation;
        const core::Crack before = p.crack;
        std::vector<transfer::SetAside> aside(1);
        transfer::Sliders sliders;
        const transfer::Lattice lattice;
        const transfer::Context context{options, table, lattice, 4, 0};
        transfer::enlist(context, p.input, p.gradient, p.crack, aside[0], sliders);
        transfer::finish(context, sliders);
        for (const Real s : aside[0].result.stress.s) EXPECT_EQ(s, 0);
        EXPECT_EQ(aside[0].result.eq_plastic_strain, p.input.step.eq_plastic_strain);
        EXPECT_EQ(aside[0].result.plastic_work + aside[0].result.decohesion_work, 0);
        EXPECT_EQ(p.crack.normal, before.normal);
        EXPECT_EQ(p.crack.opening, before.opening);
    }
}

// The step takes 0.8 of the time a wave needs through the squeezed cell: less than a full cell's nodes stand, more than
// those of a particle alone in a cell at a cut edge do.
TEST(SlideBatch, a_cut_cell_lets_go_before_a_full_one)
{
    const transfer::LawTable table = laws();
    transfer::PassOptions options;
    options.dt = 1e-5;
    const Real per_spacing = 4;
    Random random(33);
    Particle p = particle(Fate::closes, 0, options, per_spacing, random);
    p.crack.opening = 0;
    p.deformation = core::identity<Real>();
    p.deformation(2, 2) = table.constants[0].wave_speed * options.dt * per_spacing / 0.8;
    p.input.deformation = &p.deformation;
    const transfer::Lattice lattice;
    const transfer::Context context{options, table, lattice, per_spacing, 0};
    for (const Real share : {transfer::unstable_step_share, transfer::deformed_step_share}) {
        p.input.largest_share = share;
        for (const core::Sym<Real>& stress : stresses_both_ways(context, p))
            EXPECT_EQ(core::contract(stress, stress) > 0, share == transfer::unstable_step_share);
    }
}

// Both cells are squeezed so that a step takes 0.8 of their time. The other one has grown six times along two axes: its
// stress acts on twice the volume, at the same mass. If that is opening, it is void and does not count.
TEST(SlideBatch, a_cell_that_has_grown_lets_go_before_one_that_has_not)
{
    const transfer::LawTable table = laws();
    transfer::PassOptions options;
    options.dt = 1e-5;
    const Real per_spacing = 4;
    Random random(34);
    const transfer::Lattice lattice;
    const transfer::Context context{options, table, lattice, per_spacing, 0};
    struct Growth
    {
        Real along, opening;
        bool carries;
    };
    for (const Growth& growth : {Growth{1, 0, true}, Growth{6, 0, false}, Growth{6, 2, true}}) {
        Particle p = particle(Fate::stays, 0, options, per_spacing, random);
        p.crack.opening = growth.opening * p.crack.effective_length;
        p.crack.second_time = -1;
        for (Real& entry : p.input.step.stress.s) entry *= 0.1; // too little for a second crack
        p.deformation = core::identity<Real>();
        p.deformation(0, 0) = p.deformation(1, 1) = growth.along;
        p.deformation(2, 2) = table.constants[0].wave_speed * options.dt * per_spacing / 0.8;
        p.input.volume_ratio = core::determinant(p.deformation);
        p.input.largest_share = transfer::unstable_step_share;
        p.input.deformation = &p.deformation;
        for (const core::Sym<Real>& stress : stresses_both_ways(context, p))
            EXPECT_EQ(core::contract(stress, stress) > 0, growth.carries) << growth.along << " " << growth.opening;
    }
}
