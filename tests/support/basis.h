/// The basis of the free nodes at one particle, formed the plain way: what the sparse passes are compared with where
/// levels meet.
#pragma once

#include "tests/support/scene.h"

namespace support
{
/// Part of a free node's weight; a node that is reached by several slaves occurs several times.
struct Share
{
    grid::NodeAddress node;
    Vec3 position; // mm
    Real weight;   // 1
    Vec3 slope;    // 1/mm, of the weight
};

/// Where a particle's weights are taken: its rest position in the total formulation.
Vec3 weight_position(const Scene& scene, std::size_t p);

/// Phi_a(x_p) for all free nodes a: sum_i P_ia w_i over the corners i of the leaf cell the particle is in; basis gimp:
/// mean over the particle's box, cut by every plane of the finest cells, whether a leaf cell ends there or not.
std::vector<Share> basis_of(const Scene& scene, std::size_t p);

/// D_p = sum_a Phi_a (x_a - x_p) (x) (x_a - x_p) [mm^2].
Eigen::Matrix3d affine_inertia(const Scene& scene, std::size_t p);

/// Gradient of the velocity in the motion tiles, slaves and halos included [1/ms]: the one that strains the particle.
Eigen::Matrix3d velocity_gradient(const Scene& scene, std::size_t p);
} // namespace support
