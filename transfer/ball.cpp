#include "transfer/ball.h"

#include "grid/topology.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace transfer
{
namespace
{
/// An image of a coordinate in the mirrors normal to one axis: x -> sign x + offset.
struct Image
{
    Real sign = 1;
    Real offset = 0; // mm
};

/// Images of `x` along one axis, itself first, that a ball of `radius` sees between (or beyond) the planes.
std::vector<Image> images_along(Real x, Real radius, const std::vector<Real>& planes)
{
    std::vector<Image> images{{1, 0}};
    if (planes.empty()) return images;
    const auto ends = std::minmax_element(planes.begin(), planes.end());
    const auto within_reach = [&](Real at) { return at > *ends.first - radius && at < *ends.second + radius; };
    for (std::size_t n = 0; n < images.size(); ++n)
        for (const Real plane : planes) {
            const Image seen{-images[n].sign, 2 * plane - images[n].offset};
            const Real at = seen.sign * x + seen.offset;
            const bool known = std::any_of(images.begin(), images.end(), [&](const Image& other) {
                return std::abs(other.sign * x + other.offset - at) < 1e-9 * radius;
            });
            if (!known && within_reach(at)) images.push_back(seen);
        }
    return images;
}

std::vector<Real> planes_of(const PassOptions& options, const grid::Levels& levels, int axis)
{
    std::vector<Real> planes;
    for (const grid::WallPlane& wall : options.walls)
        if (wall.axis == axis) planes.push_back(levels.origin[axis] + wall.node0 * levels.spacing0);
    return planes;
}

void add(std::uint32_t particle, std::uint8_t turned, Real weight, Ball& ball)
{
    ball.particle.push_back(particle);
    ball.turned.push_back(turned);
    ball.weight.push_back(weight);
}

/// `visit(particle, offset, slot)` for the particles of one material in the cells within `reach` of a point: their
/// places from it [mm], where the formulation takes its weights, and the cells that store them.
template <class Visit>
void for_particles_near(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                        const Vec3& point, Real reach, std::uint8_t material, const Visit& visit)
{
    const bool total = options.formulation == Formulation::total;
    const auto& position = total ? particles.rest_position : particles.position;
    // In the updated formulation a particle may be up to a cell away from the one that stores it.
    for (const OccupiedCell& cell : cells_near(levels, point, reach, total ? 0 : 1))
        for (std::uint32_t p = levels.cell_start[cell.slot]; p < levels.cell_start[cell.slot + 1]; ++p)
            if (particles.material[p] == material)
                visit(p, Vec3(Vec3(position[0][p], position[1][p], position[2][p]) - point), cell.slot);
}

/// Add what the ball about `centre`, a place in the mirrors `turned`, holds; weights not yet normalised.
void collect(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
             const Vec3& centre, std::uint8_t turned, std::uint8_t material, Real radius, Ball& ball)
{
    for_particles_near(options, levels, particles, centre, radius, material,
                       [&](std::uint32_t p, const Vec3& offset, std::size_t) {
                           Real square = 0;
                           for (int a = 0; a < 3; ++a) square += offset[a] * offset[a];
                           const Real left = 1 - square / (radius * radius);
                           if (left > 0) add(p, turned, particles.rest_volume[p] * left * left, ball);
                       });
}
} // namespace

OccupiedCell occupied_cell(const grid::Levels& levels, std::size_t slot)
{
    const grid::Leaf& leaf = levels.leaves[slot / grid::leaf_cells];
    const int c = static_cast<int>(slot % grid::leaf_cells);
    return {leaf.level, leaf.origin + Index3(c >> 6, c >> 3 & 7, c & 7), slot};
}

Vec3 centre_of(const grid::Levels& levels, const OccupiedCell& cell)
{
    return levels.origin + levels.spacing(cell.level) * (cell.index.cast<Real>() + Vec3::Constant(Real(0.5)));
}

std::vector<Seen> images_of(const PassOptions& options, const grid::Levels& levels, const Vec3& place, Real reach)
{
    std::array<std::vector<Image>, 3> along;
    for (int a = 0; a < 3; ++a)
        along[static_cast<std::size_t>(a)] = images_along(place[a], reach, planes_of(options, levels, a));
    std::vector<Seen> images;
    for (const Image& x : along[0])
        for (const Image& y : along[1])
            for (const Image& z : along[2]) {
                const unsigned turned = (x.sign < 0 ? 1u : 0u) | (y.sign < 0 ? 2u : 0u) | (z.sign < 0 ? 4u : 0u);
                images.push_back(
                    {Vec3(x.sign * place[0] + x.offset, y.sign * place[1] + y.offset, z.sign * place[2] + z.offset),
                     static_cast<std::uint8_t>(turned)});
            }
    return images;
}

std::vector<OccupiedCell> cells_near(const grid::Levels& levels, const Vec3& point, Real reach, int margin)
{
    std::vector<OccupiedCell> cells;
    for (int level = 0; level < levels.count; ++level) {
        const Real spacing = levels.spacing(level);
        Index3 lower, upper;
        for (int a = 0; a < 3; ++a) {
            lower[a] = static_cast<int>(std::floor((point[a] - reach - levels.origin[a]) / spacing)) - margin;
            upper[a] = static_cast<int>(std::floor((point[a] + reach - levels.origin[a]) / spacing)) + margin;
        }
        Index3 at;
        for (at[0] = lower[0]; at[0] <= upper[0]; ++at[0])
            for (at[1] = lower[1]; at[1] <= upper[1]; ++at[1])
                for (at[2] = lower[2]; at[2] <= upper[2]; ++at[2]) {
                    const std::int64_t slot = grid::active_slot(levels, level, at);
                    if (slot < 0) continue;
                    const auto place = static_cast<std::size_t>(slot);
                    if (levels.cell_start[place] != levels.cell_start[place + 1]) cells.push_back({level, at, place});
                }
    }
    return cells;
}

Ball ball_of_cell(const grid::Levels& levels, const particles::Particles& particles, std::size_t slot,
                  std::uint8_t material)
{
    Ball ball;
    for (std::uint32_t p = levels.cell_start[slot]; p < levels.cell_start[slot + 1]; ++p) {
        if (particles.material[p] != material) continue;
        add(p, 0, particles.rest_volume[p], ball);
    }
    return ball;
}

Ball ball_ahead(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                const OccupiedCell& cell, std::uint8_t material, const Vec3& way, Real length)
{
    Ball ball = ball_of_cell(levels, particles, cell.slot, material);
    const Real half = levels.spacing(cell.level) / 2, end = length - half;
    if (end <= half) return ball;
    for (const Seen& image : images_of(options, levels, centre_of(levels, cell), end)) {
        const Vec3 seen_way = turned_over(image.turned, way);
        for_particles_near(options, levels, particles, image.place, end, material,
                           [&](std::uint32_t p, const Vec3& offset, std::size_t slot) {
                               const Real along = offset.dot(seen_way);
                               const bool ahead = along > 0 && along <= end;
                               if ((slot == cell.slot && image.turned == 0) || !ahead) return;
                               if ((offset - along * seen_way).squaredNorm() <= half * half)
                                   add(p, image.turned, particles.rest_volume[p], ball);
                           });
    }
    return ball;
}

Ball ball_about(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                const OccupiedCell& cell, std::uint8_t material, Real radius)
{
    Ball ball;
    for (const Seen& image : images_of(options, levels, centre_of(levels, cell), radius))
        collect(options, levels, particles, image.place, image.turned, material, radius, ball);
    if (ball.particle.empty()) return ball_of_cell(levels, particles, cell.slot, material);
    return ball;
}
} // namespace transfer
