#include "io/voxel_sums.h"

#include "io/particle_columns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace io
{
namespace
{
constexpr Real negligible = 1e-6; // 1, share of a particle's side

/// Blocks by position; particles come in cell order, so the block found last is mostly the next one too.
class BlockTable
{
public:
    VoxelBlock& at(const Index3& voxel)
    {
        const Index3 origin(voxel.x() & ~7, voxel.y() & ~7, voxel.z() & ~7);
        if (!blocks_.empty() && blocks_[last_].origin == origin) return blocks_[last_];
        const auto [place, fresh] = number_.try_emplace(key(origin), blocks_.size());
        if (fresh) blocks_.emplace_back().origin = origin;
        last_ = place->second;
        return blocks_[last_];
    }
    std::vector<VoxelBlock> take() { return std::move(blocks_); }

private:
    /// 21 bits per axis: blocks within 2^20 of the origin.
    static std::uint64_t key(const Index3& origin)
    {
        const auto bits = [](int i) { return static_cast<std::uint64_t>(i >> 3) & 0x1fffff; };
        return bits(origin.x()) << 42 | bits(origin.y()) << 21 | bits(origin.z());
    }
    std::unordered_map<std::uint64_t, std::size_t> number_;
    std::vector<VoxelBlock> blocks_;
    std::size_t last_ = 0;
};

/// A particle of the coarsest of eight levels, alone in its cell, is 128 voxels wide and touches one more.
constexpr std::size_t most_touched = 129;

/// Voxels an interval touches along one axis and the share of it in each.
struct Overlap
{
    int first = 0;
    int count = 0;
    std::array<Real, most_touched> share; // the first `count`
};

/// Overlap of [centre - side/2, centre + side/2], in units of the voxel, with the voxels of one axis.
/// @pre side <= most_touched - 1
Overlap overlap(Real centre, Real side)
{
    const Real lower = centre - side / 2, upper = centre + side / 2;
    Overlap result;
    result.first = static_cast<int>(std::floor(lower + negligible * side));
    for (int i = result.first; i < upper - negligible * side; ++i) {
        const Real share = std::min<Real>(upper, i + 1) - std::max<Real>(lower, i);
        result.share[static_cast<std::size_t>(result.count++)] = share / side;
    }
    return result;
}

struct Carried
{
    Real mass, damage, eq_plastic_strain;
    std::array<Real, 3> velocity;
};

void add(const Carried& carried, Real share, std::size_t voxel, VoxelBlock& block)
{
    const Real mass = carried.mass * share;
    block.mass[voxel] += static_cast<float>(mass);
    block.damage[voxel] += static_cast<float>(mass * carried.damage);
    block.eq_plastic_strain[voxel] += static_cast<float>(mass * carried.eq_plastic_strain);
    for (std::size_t a = 0; a < 3; ++a) block.momentum[a][voxel] += static_cast<float>(mass * carried.velocity[a]);
}

void spread(const Carried& carried, const std::array<Overlap, 3>& box, BlockTable& table)
{
    for (int i = 0; i < box[0].count; ++i)
        for (int j = 0; j < box[1].count; ++j)
            for (int k = 0; k < box[2].count; ++k) {
                const Index3 voxel(box[0].first + i, box[1].first + j, box[2].first + k);
                const Real share = box[0].share[static_cast<std::size_t>(i)] *
                                   box[1].share[static_cast<std::size_t>(j)] *
                                   box[2].share[static_cast<std::size_t>(k)];
                const int cell = grid::cell_index(voxel.x() & 7, voxel.y() & 7, voxel.z() & 7);
                add(carried, share, static_cast<std::size_t>(cell), table.at(voxel));
            }
}
} // namespace

std::vector<VoxelBlock> sum_voxels(const particles::Particles& particles, const grid::Levels& levels,
                                   int particles_per_cell)
{
    const std::vector<Real> side = particle_sides(particles, levels, particles_per_cell);
    const std::vector<Real> damage = particle_damage(particles);
    const Real h = levels.spacing(levels.count - 1);
    BlockTable table;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        std::array<Overlap, 3> box;
        for (std::size_t a = 0; a < 3; ++a)
            box[a] = overlap((particles.position[a][p] - levels.origin[static_cast<int>(a)]) / h, side[p] / h);
        const auto& v = particles.velocity;
        spread({particles.mass[p], damage[p], particles.eq_plastic_strain[p], {v[0][p], v[1][p], v[2][p]}}, box, table);
    }
    return table.take();
}
} // namespace io
