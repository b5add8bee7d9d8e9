#include "particles/seed.h"

#include <algorithm>
#include <cmath>

namespace particles
{
namespace
{
/// How many corners of a cube about a point are inside of a shape.
int corners_inside(const geometry::Shape& shape, const Vec3& at, Real half)
{
    int inside = 0;
    for (int c = 0; c < 8; ++c)
        inside += shape.contains(at + half * Vec3(c & 4 ? 1 : -1, c & 2 ? 1 : -1, c & 1 ? 1 : -1)) ? 1 : 0;
    return inside;
}

/// Share of a cube of that width about a point: 1/2 - d / width where a surface cuts it. A CSG distance also comes near
/// zero where parts meet within metal or within a void, and there it says nothing of a surface.
Real share_of_cube(const geometry::Shape& shape, const Vec3& at, Real width)
{
    const Real distance = shape.distance(at), share = Real(0.5) - distance / width;
    if (share <= 0 || share >= 1) return std::clamp(share, Real(0), Real(1));
    // Corners of a larger cube, so that no curved surface slips between them.
    const int inside = corners_inside(shape, at, Real(0.75) * width);
    const bool seam = std::abs(distance) < 1e-6 * width; // the point itself then says nothing
    if (inside == 8 && (distance < 0 || seam)) return 1;
    if (inside == 0 && (distance >= 0 || seam)) return 0;
    return share;
}
} // namespace

Real inside_fraction(const geometry::Shape& shape, const Vec3& centre, Real half, EdgeTreatment edge)
{
    // CSG distances are lower bounds of the true distance, so a large value is a safe decision.
    const Real distance = shape.distance(centre);
    const Real reach = half * std::sqrt(Real(3));
    if (distance > reach) return 0;
    if (distance < -reach) return 1;
    constexpr int samples = 4;
    const Real width = 2 * half / samples;
    Real inside = 0;
    for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j)
            for (int k = 0; k < samples; ++k) {
                const auto offset = [&](int n) { return half * ((2 * n + 1) / Real(samples) - 1); };
                const Vec3 at = centre + Vec3(offset(i), offset(j), offset(k));
                inside += edge == EdgeTreatment::distance ? share_of_cube(shape, at, width)
                                                          : Real(shape.contains(at) ? 1 : 0);
            }
    return inside / (samples * samples * samples);
}

namespace
{
void append(const SeedTraits& traits, const Vec3& at, Real volume, int level, Particles& particles)
{
    for (std::size_t a = 0; a < 3; ++a) {
        particles.position[a].push_back(at[static_cast<int>(a)]);
        particles.rest_position[a].push_back(at[static_cast<int>(a)]);
        particles.velocity[a].push_back(traits.velocity[static_cast<int>(a)]);
    }
    for (Column& component : particles.stress) component.push_back(0);
    particles.rest_volume.push_back(volume);
    particles.eq_plastic_strain.push_back(0);
    particles.crack.push_back(-1);
    particles.id.push_back(static_cast<std::uint32_t>(particles.id.size()));
    particles.target_level.push_back(static_cast<std::uint8_t>(level));
    particles.size_level.push_back(static_cast<std::uint8_t>(level));
    particles.material.push_back(traits.material);
    particles.body.push_back(traits.body);
    particles.away.push_back(0);
    particles.mass.push_back(traits.density * volume);
}
} // namespace

int seed_cell(const geometry::Shape& shape, const SeedTraits& traits, const Vec3& lower, Real spacing, int per_axis,
              int level, Particles& particles)
{
    const Real side = spacing / per_axis;
    int added = 0;
    for (int i = 0; i < per_axis; ++i)
        for (int j = 0; j < per_axis; ++j)
            for (int k = 0; k < per_axis; ++k) {
                const Vec3 at = lower + side * Vec3(i + Real(0.5), j + Real(0.5), k + Real(0.5));
                const Real fraction = traits.edge == EdgeTreatment::staircase
                                          ? Real(shape.contains(at) ? 1 : 0)
                                          : inside_fraction(shape, at, side / 2, traits.edge);
                if (fraction < smallest_fraction) continue;
                append(traits, at, fraction * side * side * side, level, particles);
                ++added;
            }
    return added;
}
} // namespace particles
