#include "refine/zone.h"

#include <algorithm>
#include <cmath>

namespace refine
{
namespace
{
bool touches(const Zone& zone, const Vec3& lower, Real spacing)
{
    const Vec3 centre = lower + Vec3::Constant(spacing / 2);
    const Real distance = zone.shape.distance(centre) - zone.margin;
    const Real reach = spacing * std::sqrt(Real(3)) / 2;
    if (distance < 0) return true;
    if (distance > reach) return false; // distances outside are lower bounds: the corners are out too
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner = lower + spacing * Vec3(c >> 2, c >> 1 & 1, c & 1);
        if (zone.shape.distance(corner) < zone.margin) return true;
    }
    return false;
}

void subdivide(const std::vector<Zone>& zones, const Lattice& lattice, int level, const Index3& cell,
               grid::Refinement& refinement)
{
    if (level + 1 >= lattice.levels) return;
    const Real spacing = lattice.spacing0 / static_cast<Real>(1 << level);
    if (wanted_level(zones, lattice.origin + spacing * cell.cast<Real>(), spacing) <= level) return;
    refinement.subdivide(level, cell);
    for (int c = 0; c < 8; ++c)
        subdivide(zones, lattice, level + 1, 2 * cell + Index3(c >> 2, c >> 1 & 1, c & 1), refinement);
}
} // namespace

int level_at(const std::vector<Zone>& zones, const Vec3& point)
{
    int level = 0;
    for (const Zone& zone : zones)
        if (zone.shape.distance(point) < zone.margin) level = std::max(level, zone.level);
    return level;
}

int wanted_level(const std::vector<Zone>& zones, const Vec3& lower, Real spacing)
{
    int level = 0;
    for (const Zone& zone : zones)
        if (zone.level > level && touches(zone, lower, spacing)) level = zone.level;
    return level;
}

grid::Refinement refinement_of(const std::vector<Zone>& zones, const Lattice& lattice, const geometry::Bounds& bounds)
{
    grid::Refinement refinement(lattice.levels);
    const auto index = [&](const Vec3& x) { return grid::cell_at((x - lattice.origin) / lattice.spacing0, 0); };
    const Index3 lower = index(bounds.lower);
    const Index3 upper = index(bounds.upper);
    for (int i = lower[0]; i <= upper[0]; ++i)
        for (int j = lower[1]; j <= upper[1]; ++j)
            for (int k = lower[2]; k <= upper[2]; ++k) subdivide(zones, lattice, 0, Index3(i, j, k), refinement);
    refinement.balance();
    return refinement;
}
} // namespace refine
