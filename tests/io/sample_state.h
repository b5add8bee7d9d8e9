/// Synthetic states for output tests: a two-level block of particles with every member different from its default.
#pragma once

#include "solver/state.h"

#include <cmath>
#include <cstdint>

namespace sample
{
/// Particles of the cells of one leaf, `per_axis`^3 in each cell, in cell order; the first `layers` cell layers along
/// x.
inline void add_leaf(int level, const Index3& origin, int layers, int per_axis, solver::State& state)
{
    grid::Levels& levels = state.levels;
    particles::Particles& particles = state.particles;
    grid::Leaf& leaf = levels.leaves.emplace_back();
    leaf.level = level;
    leaf.origin = origin;
    leaf.neighbour.fill(-1);
    const Real h = levels.spacing(level), side = h / per_axis;
    for (int cell = 0; cell < grid::leaf_cells; ++cell) {
        levels.cell_start.push_back(static_cast<std::uint32_t>(particles.mass.size()));
        const Index3 place(cell / 64, cell / 8 % 8, cell % 8);
        levels.cell_active.push_back(place.x() < layers ? 1 : 0);
        if (place.x() >= layers) continue;
        for (int part = 0; part < per_axis * per_axis * per_axis; ++part) {
            const Index3 sub(part / (per_axis * per_axis), part / per_axis % per_axis, part % per_axis);
            const Vec3 x =
                levels.origin + (origin + place).cast<Real>() * h + (sub.cast<Real>() + Vec3::Constant(0.5)) * side;
            for (int a = 0; a < 3; ++a) {
                particles.position[static_cast<std::size_t>(a)].push_back(x[a]);
                particles.rest_position[static_cast<std::size_t>(a)].push_back(x[a] - Real(0.01) * (a + 1));
                particles.velocity[static_cast<std::size_t>(a)].push_back(x[a] * (a + 1));
            }
            for (std::size_t c = 0; c < 6; ++c) particles.stress[c].push_back(100 * x[0] + 10 * static_cast<Real>(c));
            for (std::size_t c = 0; c < 9; ++c) particles.deformation_gradient[c].push_back(c % 4 == 0 ? 1.1 : 0.01);
            particles.rest_volume.push_back(side * side * side);
            particles.mass.push_back(7.81e-3 * side * side * side);
            particles.eq_plastic_strain.push_back(std::abs(x[0]) / 10);
            particles.crack.push_back(-1);
            particles.id.push_back(static_cast<std::uint32_t>(particles.id.size()) + 7);
            particles.target_level.push_back(static_cast<std::uint8_t>(level));
            particles.size_level.push_back(static_cast<std::uint8_t>(level));
            particles.material.push_back(0);
            particles.body.push_back(static_cast<std::uint8_t>(part % 2));
            particles.away.push_back(part == 0 ? 1 : 0);
        }
    }
}

/// Every tenth particle is cracked; the numbers are all different.
inline void add_cracks(particles::Particles& particles)
{
    for (std::size_t p = 0; p < particles.size(); p += 10) {
        particles.crack[p] = static_cast<std::int32_t>(particles.cracks.size());
        core::Crack& crack = particles.cracks.emplace_back();
        const Real seed = Real(1) / static_cast<Real>(3 + p);
        crack.normal = {0, 0.6, 0.8};
        crack.damage = 1 - seed;
        crack.opening = seed / 7;
        crack.slip = {seed, 2 * seed, 3 * seed};
        crack.normal_strength = 1000 * seed;
        crack.tangential_strength = 900 * seed;
        crack.effective_length = 0.1 + seed;
        crack.surface_energy = 3 + seed;
        crack.snap_back_ratio = 0.3 + seed;
        crack.onset_time = 0.01 + seed;
        crack.separation_time = 0.02 + seed;
        crack.second_time = 0.03 + seed;
        crack.drop_traction = {5 * seed, 6 * seed};
        crack.mode = 1 + static_cast<std::int32_t>(p / 10 % 3);
        crack.particle_id = particles.id[p];
    }
}

/// 8 mm^3-ish block at (10, 20, 30) mm: one coarse leaf of h = 0.25 mm (first 4 layers along x), beside it one fine
/// leaf.
inline solver::State state()
{
    solver::State state;
    state.levels.spacing0 = 0.25;
    state.levels.count = 2;
    state.levels.origin = Vec3(10, 20, 30);
    add_leaf(0, Index3(0, 0, 0), 4, 2, state);
    add_leaf(1, Index3(8, 0, 0), 8, 2, state);
    state.levels.cell_start.push_back(static_cast<std::uint32_t>(state.particles.size()));
    state.levels.level_start = {0, 1, 2};
    add_cracks(state.particles);

    state.clock = {400, Real(0.1) / 3, 1.25e-5};
    for (int i = 0; i < 2; ++i) {
        const Real seed = Real(1) / (7 + i);
        state.loads.push_back({Vec3(seed, 2 * seed, 3), seed / 3, seed / 5, Vec3(1, seed, 9), Vec3(seed, 4, 5),
                               seed / 11, Vec3(6, seed, 8), seed / 13, 17 * seed});
    }
    state.ligaments.push_back({0.1, 2000, 0.3, 0.4, 5000, 0.6, -1, 0.1, 0.2, 1.0 / 3});
    state.events = {{100, 0.1, 2000, 0.3, 0, 0, solver::EventKind::onset},
                    {400, 0.4, 5000, 0.6, 1.0 / 3, 0, solver::EventKind::first}};
    state.leaf_work = {{1.0 / 3, 0.25}, {7, 1.0 / 9}};
    state.folded_work = {0.125, 1.0 / 6};
    state.initial_energy = 1.0 / 7;
    state.source_work = 1.0 / 9;
    state.damped_work = 1.0 / 11;
    state.gauge_start = 1.0 / 13;
    state.largest_opening = 1.0 / 17;
    for (int i = 0; i < 3; ++i) state.samples.push_back({50 * i, i / Real(13), {i / Real(17), i / Real(19)}});
    for (int i = 0; i <= 4; ++i) {
        solver::HistoryLine& line = state.history.emplace_back();
        line.step = 100 * i;
        line.time = i / Real(120);
        line.dt = 1.25e-5;
        line.force_upper = 1000 * i / Real(3);
        line.force_lower = -line.force_upper * 0.99;
        line.cod = i / Real(7);
        line.energy = {0.1 * i, 1.0 / (i + 3), 3.0 * i, 0.5 * i, 4.0 * i, 0.25, 0.125 * i};
        line.max_damage = i / Real(4);
        line.separated_particles = static_cast<std::uint64_t>(i);
        line.particles = {2048, 4096 + static_cast<std::uint64_t>(i)};
    }
    state.gauge_upper = {7, 9, 11};
    state.gauge_lower = {8};
    return state;
}

/// Three levels side by side along x: four layers of a coarse leaf (h = 0.25 mm), four of a middle one, seven of a fine
/// one, so that the last layer of the fine one fills half of a middle cell. Everything is moved by `shift` coarse cells
/// along x, a multiple of 8; the particles are intact.
inline solver::State three_levels(int shift = 0)
{
    solver::State state;
    state.levels.spacing0 = 0.25;
    state.levels.count = 3;
    state.levels.origin = Vec3(10, 20, 30);
    add_leaf(0, Index3(shift, 0, 0), 4, 2, state);
    add_leaf(1, Index3(2 * shift + 8, 0, 0), 4, 2, state);
    add_leaf(2, Index3(4 * shift + 24, 0, 0), 7, 2, state);
    state.levels.cell_start.push_back(static_cast<std::uint32_t>(state.particles.size()));
    state.levels.level_start = {0, 1, 2, 3};
    state.clock = {400, Real(0.1) / 3, 1.25e-5};
    return state;
}
} // namespace sample
