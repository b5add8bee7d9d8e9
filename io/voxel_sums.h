/// Particles spread over the voxels of the finest level: sums per voxel, grouped by blocks of 8^3.
#pragma once

#include "core/real.h"
#include "grid/levels.h"
#include "particles/particles.h"

#include <array>
#include <cstddef>
#include <vector>

namespace io
{
/// Sums over particles of (overlap share) x mass x quantity in one block; z runs fastest.
struct VoxelBlock
{
    using Sums = std::array<float, grid::leaf_cells>;
    Index3 origin = Index3::Zero(); // voxel index of the lower corner, a multiple of 8
    Sums mass{};                    // g
    Sums damage{};                  // g
    Sums eq_plastic_strain{};       // g
    std::array<Sums, 3> momentum{}; // g mm/ms
};

/// Spread all particles; voxel (i, j, k) is [i, i + 1) h relative to levels.origin, with h of the finest level.
///
/// The shares of a particle sum to 1 up to the overlaps below 1e-6 of its side, which are dropped so that a particle
/// that fits a voxel up to round-off does not touch the next. Serial and in particle order.
/// @cost  about 8 voxels per particle
std::vector<VoxelBlock> sum_voxels(const particles::Particles& particles, const grid::Levels& levels,
                                   int particles_per_cell);
} // namespace io
