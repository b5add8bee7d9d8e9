#include "tests/support/basis.h"

#include "grid/topology.h"

#include <cmath>

namespace support
{
namespace
{
grid::NodeAddress owner(const grid::Levels& levels, const grid::CellKey& node)
{
    const std::int32_t leaf = grid::leaf_of(levels, node.level, node.cell);
    const Index3 local = node.cell - levels.leaves[static_cast<std::size_t>(leaf)].origin;
    return {leaf, grid::tile_index(local[0], local[1], local[2])};
}

/// Share a corner's weight among its masters, or keep it if the corner is free.
void spread(const grid::Levels& levels, const grid::CellKey& node, Real weight, const Vec3& slope,
            std::vector<Share>& shares)
{
    const grid::NodeAddress at = owner(levels, node);
    if (levels.constrained[static_cast<std::size_t>(at.leaf) * grid::tile_nodes + static_cast<std::size_t>(at.node)] ==
        0) {
        shares.push_back({at, levels.origin + levels.spacing(node.level) * node.cell.cast<Real>(), weight, slope});
        return;
    }
    // Half to each side along every axis; on an even index both sides are the same node.
    for (int c = 0; c < 8; ++c) {
        const Index3 side(c >> 2, c >> 1 & 1, c & 1);
        Index3 master;
        for (int a = 0; a < 3; ++a) master[a] = (node.cell[a] + (node.cell[a] & 1) * (2 * side[a] - 1)) / 2;
        spread(levels, {node.level - 1, master}, weight / 8, slope / 8, shares);
    }
}

struct Place
{
    grid::CellKey cell;
    Vec3 local; // 1, in [0, 1)
};

Place place_at(const Scene& scene, const Vec3& x)
{
    const Vec3 scaled = (x - scene.levels.origin) * (1 / scene.levels.spacing0);
    const grid::CellKey cell = scene.refinement.locate(scaled);
    return {cell, scaled * static_cast<Real>(1 << cell.level) - cell.cell.cast<Real>()};
}

/// Where weights are taken, and how much each place counts.
struct Sample
{
    Place place;
    Real share;
};

struct Interval
{
    Real middle, share;
};

/// [centre - half, centre + half] cut at the multiples of `spacing` counted from `origin`.
std::vector<Interval> intervals_of(Real centre, Real half, Real origin, Real spacing)
{
    std::vector<Real> ends{centre - half};
    for (Real n = std::ceil((centre - half - origin) / spacing); origin + n * spacing < centre + half; ++n)
        ends.push_back(origin + n * spacing);
    ends.push_back(centre + half);
    std::vector<Interval> cut;
    for (std::size_t n = 1; n < ends.size(); ++n)
        if (ends[n] - ends[n - 1] > 1e-12 * spacing)
            cut.push_back({(ends[n] + ends[n - 1]) / 2, (ends[n] - ends[n - 1]) / (2 * half)});
    return cut;
}

std::vector<Sample> samples_of(const Scene& scene, std::size_t p)
{
    const Vec3 x = weight_position(scene, p);
    if (!transfer::uses_boxes(scene.options)) return {{place_at(scene, x), 1}};
    const Real half = scene.levels.spacing(scene.particles.size_level[p]) / (2 * scene.options.per_axis);
    std::vector<Interval> cut[3];
    for (int a = 0; a < 3; ++a)
        cut[a] = intervals_of(x[a], half, scene.levels.origin[a], scene.levels.spacing(scene.levels.count - 1));
    std::vector<Sample> samples;
    for (const Interval& i : cut[0])
        for (const Interval& j : cut[1])
            for (const Interval& k : cut[2])
                samples.push_back({place_at(scene, {i.middle, j.middle, k.middle}), i.share * j.share * k.share});
    return samples;
}

/// `visit(corner node, weight, slope [1/mm])` for the eight corners of the cells of all samples.
template <class Visit>
void for_corners(const Scene& scene, std::size_t p, const Visit& visit)
{
    for (const Sample& sample : samples_of(scene, p))
        for (int c = 0; c < 8; ++c) {
            const Index3 bits(c >> 2, c >> 1 & 1, c & 1);
            Vec3 weight, slope;
            for (int a = 0; a < 3; ++a) {
                weight[a] = bits[a] == 1 ? sample.place.local[a] : 1 - sample.place.local[a];
                slope[a] = (2 * bits[a] - 1) / scene.levels.spacing(sample.place.cell.level);
            }
            const Vec3 weight_slope(slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                    weight[0] * weight[1] * slope[2]);
            visit(grid::CellKey{sample.place.cell.level, sample.place.cell.cell + bits}, sample.share * weight.prod(),
                  Vec3(sample.share * weight_slope));
        }
}
} // namespace

Vec3 weight_position(const Scene& scene, std::size_t p)
{
    return vector_of(scene.options.formulation == transfer::Formulation::total ? scene.particles.rest_position
                                                                               : scene.particles.position,
                     p);
}

std::vector<Share> basis_of(const Scene& scene, std::size_t p)
{
    std::vector<Share> shares;
    for_corners(scene, p, [&](const grid::CellKey& node, Real weight, const Vec3& slope) {
        spread(scene.levels, node, weight, slope, shares);
    });
    return shares;
}

Eigen::Matrix3d affine_inertia(const Scene& scene, std::size_t p)
{
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const Share& share : basis_of(scene, p)) {
        const Vec3 arm = share.position - weight_position(scene, p);
        inertia += share.weight * arm * arm.transpose();
    }
    return inertia;
}

Eigen::Matrix3d velocity_gradient(const Scene& scene, std::size_t p)
{
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for_corners(scene, p, [&](const grid::CellKey& node, Real, const Vec3& slope) {
        const grid::NodeAddress at = owner(scene.levels, node);
        const auto& motion = scene.levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
        gradient += vector_of(motion.velocity) * slope.transpose();
    });
    return gradient;
}
} // namespace support
