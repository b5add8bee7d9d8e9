#include "refine/regrid.h"

#include "core/parallel.h"
#include "grid/topology.h"
#include "particles/order.h"
#include "particles/split.h"
#include "transfer/scaled_position.h"

#include <algorithm>
#include <numeric>

namespace refine
{
namespace
{
std::vector<grid::CellKey> locate_all(const grid::Levels& levels, const grid::Refinement& refinement,
                                      const std::array<particles::Column, 3>& at, const particles::Particles& particles)
{
    const std::size_t count = particles.size();
    for (std::size_t p = 0; p < count; ++p)
        transfer::placed_position(levels, at, particles, p); // in order: the first is named
    std::vector<grid::CellKey> key(count);
    constexpr std::size_t block = 4096;
    core::parallel_for((count + block - 1) / block, [&](std::size_t b) {
        for (std::size_t p = b * block; p < std::min(count, (b + 1) * block); ++p)
            key[p] = refinement.locate(transfer::scaled_position(levels, at, p));
    });
    return key;
}
} // namespace

grid::Refinement refinement_from_targets(const grid::Levels& levels, const particles::Particles& particles)
{
    grid::Refinement refinement(levels.count);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const int target = particles.target_level[p];
        if (target == 0) continue;
        refinement.subdivide(target - 1,
                             grid::cell_at(transfer::scaled_position(levels, particles.position, p), target - 1));
    }
    refinement.balance();
    return refinement;
}

std::size_t split_into_finer_cells(const grid::Levels& levels, const grid::Refinement& refinement, int per_axis,
                                   particles::Particles& particles)
{
    std::size_t total = 0;
    for (int round = 1; round < levels.count; ++round) {
        const auto key = locate_all(levels, refinement, particles.position, particles);
        std::vector<std::uint32_t> parents;
        for (std::uint32_t p = 0; p < key.size(); ++p)
            if (particles.size_level[p] < key[p].level) parents.push_back(p);
        total += particles::split(parents, levels.spacing0, per_axis, particles);
    }
    return total;
}

void order(transfer::Formulation formulation, const grid::Refinement& refinement, grid::Levels& levels,
           particles::Particles& particles)
{
    const auto& at = formulation == transfer::Formulation::total ? particles.rest_position : particles.position;
    const auto key = locate_all(levels, refinement, at, particles);
    std::vector<grid::CellKey> occupied = key;
    grid::sort_unique(occupied);
    grid::build(occupied, levels);

    std::vector<std::size_t> slot(key.size());
    levels.cell_start.assign(levels.leaves.size() * grid::leaf_cells + 1, 0);
    for (std::size_t p = 0; p < key.size(); ++p) {
        slot[p] = static_cast<std::size_t>(grid::slot_of(levels, key[p]));
        ++levels.cell_start[slot[p] + 1];
    }
    std::partial_sum(levels.cell_start.begin(), levels.cell_start.end(), levels.cell_start.begin());
    std::vector<std::uint32_t> next(levels.cell_start.begin(), levels.cell_start.end() - 1);
    std::vector<std::uint32_t> ordered(key.size());
    for (std::uint32_t p = 0; p < key.size(); ++p) ordered[next[slot[p]]++] = p;
    core::parallel_for(next.size(), [&](std::size_t s) {
        std::sort(ordered.begin() + levels.cell_start[s], ordered.begin() + levels.cell_start[s + 1],
                  [&](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
    });
    particles::reorder(ordered, particles);
    std::fill(particles.away.begin(), particles.away.end(), std::uint8_t(0));
}
} // namespace refine
