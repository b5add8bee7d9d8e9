#include "io/particle_columns.h"

#include "core/contract.h"
#include "core/equivalent_stress.h"
#include "core/tensor.h"
#include "particles/tensors.h"

#include <array>
#include <functional>

namespace io
{
namespace
{
std::vector<Real> copied(const particles::Column& column)
{
    return {column.begin(), column.end()};
}

using particles::Crack;
using particles::Particles;

template <std::size_t N>
std::vector<Real> interleave(const std::array<particles::Column, N>& columns)
{
    const std::size_t count = columns[0].size();
    std::vector<Real> rows(count * N);
    for (std::size_t p = 0; p < count; ++p)
        for (std::size_t c = 0; c < N; ++c) rows[p * N + c] = columns[c][p];
    return rows;
}

template <class Integer>
std::vector<Real> as_real(const std::vector<Integer>& column)
{
    return {column.begin(), column.end()};
}

/// `value(crack, component)` for cracked particles, 0 for intact ones.
template <class Value>
std::vector<Real> from_cracks(const Particles& particles, std::size_t components, Value value)
{
    std::vector<Real> rows(particles.size() * components, Real(0));
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.crack[p] < 0) continue;
        const Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
        for (std::size_t c = 0; c < components; ++c) rows[p * components + c] = value(crack, c);
    }
    return rows;
}

std::vector<Real> von_mises(const Particles& particles)
{
    std::vector<Real> column(particles.size());
    for (std::size_t p = 0; p < column.size(); ++p)
        column[p] = core::equivalent_stress(particles::stress_of(particles, p));
    return column;
}

std::vector<Real> displacement(const Particles& particles)
{
    std::vector<Real> rows(3 * particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p)
        for (std::size_t a = 0; a < 3; ++a) rows[3 * p + a] = particles.position[a][p] - particles.rest_position[a][p];
    return rows;
}

/// Level of the home cell, from the particle range of every leaf.
std::vector<Real> home_level(const Particles& particles, const grid::Levels& levels)
{
    std::vector<Real> column(particles.size());
    for (std::size_t leaf = 0; leaf < levels.leaves.size(); ++leaf) {
        const std::uint32_t end = levels.cell_start[(leaf + 1) * grid::leaf_cells];
        for (std::uint32_t p = levels.cell_start[leaf * grid::leaf_cells]; p < end; ++p)
            column[p] = levels.leaves[leaf].level;
    }
    return column;
}
} // namespace

std::vector<Real> particle_points(const Particles& particles)
{
    return interleave(particles.position);
}

std::vector<Real> particle_volumes(const Particles& particles)
{
    std::vector<Real> volume = copied(particles.rest_volume);
    const bool total = !particles.deformation_gradient[0].empty();
    for (std::size_t p = 0; p < volume.size(); ++p)
        volume[p] *= total ? core::determinant(particles::deformation_of(particles, p)) : particles.volume_ratio[p];
    return volume;
}

std::vector<Real> particle_sides(const Particles& particles, const grid::Levels& levels, int particles_per_cell)
{
    const Real per_axis = std::cbrt(static_cast<Real>(particles_per_cell));
    std::vector<Real> side(particles.size());
    for (std::size_t p = 0; p < side.size(); ++p) side[p] = levels.spacing(particles.size_level[p]) / per_axis;
    return side;
}

std::vector<Real> particle_damage(const Particles& particles)
{
    return from_cracks(particles, 1, [](const Crack& crack, std::size_t) { return crack.damage; });
}

std::vector<Real> particle_column(const ParticleField& field, const Particles& particles, const grid::Levels& levels)
{
    const std::string_view name = field.name;
    if (name == "damage") return particle_damage(particles);
    if (name == "failure_mode")
        return from_cracks(particles, 1, [](const Crack& crack, std::size_t) { return static_cast<Real>(crack.mode); });
    if (name == "crack_normal")
        return from_cracks(particles, 3, [](const Crack& crack, std::size_t axis) { return crack.normal[axis]; });
    if (name == "eq_plastic_strain") return copied(particles.eq_plastic_strain);
    if (name == "von_mises") return von_mises(particles);
    if (name == "stress") return interleave(particles.stress);
    if (name == "velocity") return interleave(particles.velocity);
    if (name == "displacement") return displacement(particles);
    if (name == "level") return home_level(particles, levels);
    if (name == "id") return as_real(particles.id);
    if (name == "mass") return copied(particles.mass);
    if (name == "volume") return particle_volumes(particles);
    CLEAVE_ASSERTS(false); // a field of the table without a column here
    return {};
}
} // namespace io
