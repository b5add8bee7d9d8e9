#include "refine/estimate.h"

#include <cmath>

namespace refine
{
Real cells_around(const std::vector<geometry::Shape>& bodies, Real cell)
{
    Real cells = 0;
    for (const geometry::Shape& body : bodies) {
        const geometry::Bounds bounds = body.bounds();
        cells += ((bounds.upper - bounds.lower) / cell).array().max(1).prod();
    }
    return cells;
}

bool may_exceed(const Scene& scene, Real particles)
{
    const Real finest = scene.lattice.spacing0 / static_cast<Real>(1 << (scene.lattice.levels - 1));
    return cells_around(scene.bodies, finest) * std::pow(scene.per_axis, 3) > particles;
}

std::vector<Real> estimated_particles(const Scene& scene)
{
    constexpr int samples = 32;
    std::vector<Real> particles(static_cast<std::size_t>(scene.lattice.levels), 0);
    for (const geometry::Shape& body : scene.bodies) {
        const geometry::Bounds bounds = body.bounds();
        const Vec3 step = (bounds.upper - bounds.lower) / samples;
        for (int i = 0; i < samples; ++i)
            for (int j = 0; j < samples; ++j)
                for (int k = 0; k < samples; ++k) {
                    const Vec3 at = bounds.lower + step.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
                    if (!body.contains(at)) continue;
                    const int level = level_at(scene.zones, at);
                    const Real side = scene.lattice.spacing0 / static_cast<Real>(1 << level) / scene.per_axis;
                    particles[static_cast<std::size_t>(level)] += step.prod() / std::pow(side, 3);
                }
    }
    return particles;
}
} // namespace refine
