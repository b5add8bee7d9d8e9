#include "tests/support/basis.h"

#include "grid/topology.h"

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
void spread(const grid::Levels& levels, const grid::CellKey& node, Real weight, std::vector<Share>& shares)
{
    const grid::NodeAddress at = owner(levels, node);
    if (levels.constrained[static_cast<std::size_t>(at.leaf) * grid::tile_nodes + static_cast<std::size_t>(at.node)] ==
        0) {
        shares.push_back({at, levels.origin + levels.spacing(node.level) * node.cell.cast<Real>(), weight});
        return;
    }
    // Half to each side along every axis; on an even index both sides are the same node.
    for (int c = 0; c < 8; ++c) {
        const Index3 side(c >> 2, c >> 1 & 1, c & 1);
        Index3 master;
        for (int a = 0; a < 3; ++a) master[a] = (node.cell[a] + (node.cell[a] & 1) * (2 * side[a] - 1)) / 2;
        spread(levels, {node.level - 1, master}, weight / 8, shares);
    }
}

struct Place
{
    grid::CellKey cell;
    Vec3 local; // 1, in [0, 1)
};

Place place_of(const Scene& scene, std::size_t p)
{
    const Vec3 scaled = (weight_position(scene, p) - scene.levels.origin) * (1 / scene.levels.spacing0);
    const grid::CellKey cell = scene.refinement.locate(scaled);
    return {cell, scaled * static_cast<Real>(1 << cell.level) - cell.cell.cast<Real>()};
}

/// `visit(corner node, bits)` for the eight corners of a cell.
template <class Visit>
void for_corners(const Place& place, const Visit& visit)
{
    for (int c = 0; c < 8; ++c) {
        const Index3 bits(c >> 2, c >> 1 & 1, c & 1);
        visit(grid::CellKey{place.cell.level, place.cell.cell + bits}, bits);
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
    const Place place = place_of(scene, p);
    std::vector<Share> shares;
    for_corners(place, [&](const grid::CellKey& node, const Index3& bits) {
        Real weight = 1;
        for (int a = 0; a < 3; ++a) weight *= bits[a] == 1 ? place.local[a] : 1 - place.local[a];
        spread(scene.levels, node, weight, shares);
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
    const Place place = place_of(scene, p);
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for_corners(place, [&](const grid::CellKey& node, const Index3& bits) {
        Vec3 weight, slope;
        for (int a = 0; a < 3; ++a) {
            weight[a] = bits[a] == 1 ? place.local[a] : 1 - place.local[a];
            slope[a] = (2 * bits[a] - 1) / scene.levels.spacing(node.level);
        }
        const Vec3 weight_slope(slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                weight[0] * weight[1] * slope[2]);
        const grid::NodeAddress at = owner(scene.levels, node);
        const auto& motion = scene.levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
        gradient += vector_of(motion.velocity) * weight_slope.transpose();
    });
    return gradient;
}
} // namespace support
