#include "particles/split.h"

#include <algorithm>

namespace particles
{
namespace
{
void copy_last(Particles& particles, std::size_t from)
{
    const auto append = [&](const auto&, auto& column) {
        if (!column.empty()) column.push_back(column[from]);
    };
    Particles::for_each_real(particles, append);
    Particles::for_each_integer(particles, append);
}

void shift(Particles& particles, std::size_t p, const Vec3& offset)
{
    for (std::size_t a = 0; a < 3; ++a) {
        particles.position[a][p] += offset[static_cast<int>(a)];
        particles.rest_position[a][p] += offset[static_cast<int>(a)];
        if (particles.affine[0].empty()) continue;
        for (std::size_t b = 0; b < 3; ++b)
            particles.velocity[a][p] += particles.affine[3 * a + b][p] * offset[static_cast<int>(b)];
    }
}
} // namespace

std::size_t split(std::span<const std::uint32_t> parents, Real spacing0, int per_axis, Particles& particles)
{
    std::uint32_t next_id = 0;
    for (const std::uint32_t id : particles.id) next_id = std::max(next_id, id + 1);
    std::size_t count = 0;
    for (const std::uint32_t p : parents) {
        if (particles.crack[p] >= 0) continue;
        const Real width = spacing0 / static_cast<Real>(1 << particles.size_level[p]) / per_axis;
        particles.mass[p] /= 8;
        particles.rest_volume[p] /= 8;
        ++particles.size_level[p];
        for (int c = 1; c < 8; ++c) {
            copy_last(particles, p);
            particles.id.back() = next_id++;
        }
        const std::size_t first = particles.size() - 7;
        for (int c = 7; c >= 0; --c) {
            const Vec3 side(c & 4 ? 1 : -1, c & 2 ? 1 : -1, c & 1 ? 1 : -1);
            shift(particles, c == 0 ? p : first + static_cast<std::size_t>(c - 1), width / 4 * side);
        }
        ++count;
    }
    return count;
}
} // namespace particles
