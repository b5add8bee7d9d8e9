#include "transfer/gimp_cover.h"

#include "core/parallel.h"
#include "grid/topology.h"
#include "transfer/scaled_position.h"

#include <algorithm>
#include <cmath>

namespace transfer
{
namespace
{
/// Bounds without the part beyond a wall that the box's centre is not on.
BoxBounds inside_walls(const PassOptions& options, const BoxBounds& bounds, int level)
{
    BoxBounds b = bounds;
    for (const grid::WallPlane& plane : options.walls) {
        const int a = plane.axis;
        const Real at = static_cast<Real>(plane.node0 << level);
        if (!(b.lower[a] < at && b.upper[a] > at)) continue;
        const bool above = bounds.lower[a] + bounds.upper[a] >= 2 * at;
        // The reflected part may reach further than the rest: by less than the box, so into the same or the next cell.
        if (above) {
            b.upper[a] = std::max(b.upper[a], 2 * at - b.lower[a]);
            b.lower[a] = at;
        } else {
            b.lower[a] = std::min(b.lower[a], 2 * at - b.upper[a]);
            b.upper[a] = at;
        }
    }
    return b;
}

/// `visit(cell)` for all leaf cells of `refinement` that overlap bounds given in cells of level 0.
template <class Visit>
void for_leaf_cells(const grid::Refinement& refinement, const BoxBounds& bounds, int level, const Index3& cell,
                    const Visit& visit)
{
    const Real width = std::ldexp(Real(1), -level);
    for (int a = 0; a < 3; ++a)
        if (!(bounds.lower[a] < width * (cell[a] + 1) && bounds.upper[a] > width * cell[a])) return;
    if (level + 1 >= refinement.levels() || !refinement.subdivided(level, cell)) return visit({level, cell});
    for (int c = 0; c < 8; ++c)
        for_leaf_cells(refinement, bounds, level + 1, 2 * cell + Index3(c >> 2, c >> 1 & 1, c & 1), visit);
}

template <class Visit>
void for_leaf_cells(const grid::Refinement& refinement, const BoxBounds& bounds, int level, const Visit& visit)
{
    const Real scale = std::ldexp(Real(1), -level);
    const BoxBounds coarse{scale * bounds.lower, scale * bounds.upper};
    const CellRange range = cells_between(coarse);
    for (int i = range.first[0]; i <= range.last[0]; ++i)
        for (int j = range.first[1]; j <= range.last[1]; ++j)
            for (int k = range.first[2]; k <= range.last[2]; ++k)
                for_leaf_cells(refinement, coarse, 0, Index3(i, j, k), visit);
}

template <class Visit>
void for_range(const CellRange& range, const Visit& visit)
{
    for (int i = range.first[0]; i <= range.last[0]; ++i)
        for (int j = range.first[1]; j <= range.last[1]; ++j)
            for (int k = range.first[2]; k <= range.last[2]; ++k) visit(Index3(i, j, k));
}

constexpr std::size_t block = 4096;

/// Cells collected by `collect(p, cells)` for all particles, sorted, each once.
template <class Collect>
std::vector<grid::CellKey> collected(std::size_t count, const Collect& collect)
{
    std::vector<std::vector<grid::CellKey>> found((count + block - 1) / block);
    core::parallel_for(found.size(), [&](std::size_t b) {
        for (std::size_t p = b * block; p < std::min(count, (b + 1) * block); ++p) collect(p, found[b]);
        grid::sort_unique(found[b]);
    });
    std::vector<grid::CellKey> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    grid::sort_unique(all);
    return all;
}

/// Leaf cells coarser than the boxes that reach them.
std::vector<grid::CellKey> too_coarse(const PassOptions& options, const grid::Levels& levels,
                                      const particles::Particles& particles, const grid::Refinement& refinement)
{
    return collected(particles.size(), [&](std::size_t p, std::vector<grid::CellKey>& cells) {
        const int size = particles.size_level[p];
        if (size == 0) return;
        const BoxBounds bounds =
            inside_walls(options, box_bounds(options, levels, particles, p, size - 1, box_margin), size - 1);
        bool fine = true;
        for_range(cells_between(bounds),
                  [&](const Index3& cell) { fine = fine && refinement.subdivided(size - 1, cell); });
        if (fine) return;
        for_leaf_cells(refinement, bounds, size - 1, [&](const grid::CellKey& key) {
            if (key.level < size) cells.push_back(key);
        });
    });
}

/// Leave out the cells that hold a particle.
void drop_occupied(const grid::Levels& levels, const particles::Particles& particles,
                   const grid::Refinement& refinement, std::vector<grid::CellKey>& cells)
{
    const std::vector<grid::CellKey> occupied =
        collected(particles.size(), [&](std::size_t p, std::vector<grid::CellKey>& held) {
            const grid::CellKey key = refinement.locate(scaled_position(levels, particles.position, p));
            if (std::binary_search(cells.begin(), cells.end(), key, grid::before)) held.push_back(key);
        });
    std::vector<grid::CellKey> rest;
    std::set_difference(cells.begin(), cells.end(), occupied.begin(), occupied.end(), std::back_inserter(rest),
                        grid::before);
    cells = std::move(rest);
}

/// Leaf of `level` and number of a cell near leaf `home` of the same level, through its neighbours; leaf -1: none
/// there, or further away.
struct CellPlace
{
    std::int32_t leaf, cell;
};
CellPlace place_near(const grid::Levels& levels, std::size_t home, const Index3& cell)
{
    const grid::Leaf& leaf = levels.leaves[home];
    const Index3 local = cell - leaf.origin;
    int neighbour = 0;
    for (int a = 0; a < 3; ++a) {
        const int step = local[a] >> 3;
        if (step < -1 || step > 1) return {-1, 0};
        neighbour = 3 * neighbour + step + 1;
    }
    return {leaf.neighbour[static_cast<std::size_t>(neighbour)],
            grid::cell_index(local[0] & 7, local[1] & 7, local[2] & 7)};
}

bool is_active(const grid::Levels& levels, const CellPlace& at)
{
    return at.leaf >= 0 && levels.cell_active[static_cast<std::size_t>(at.leaf) * grid::leaf_cells +
                                              static_cast<std::size_t>(at.cell)] != 0;
}

/// Cells that boxes reach and that are not active.
std::vector<grid::CellKey> missing(const PassOptions& options, const grid::Refinement& refinement,
                                   const particles::Particles& particles, const grid::Levels& levels)
{
    std::vector<std::vector<grid::CellKey>> found(levels.leaves.size());
    core::parallel_for(found.size(), [&](std::size_t n) {
        const int level = levels.leaves[n].level;
        for (std::uint32_t p = levels.cell_start[n * grid::leaf_cells];
             p < levels.cell_start[(n + 1) * grid::leaf_cells]; ++p) {
            const BoxBounds bounds =
                inside_walls(options, box_bounds(options, levels, particles, p, level, box_margin), level);
            bool here = true;
            for_range(cells_between(bounds),
                      [&](const Index3& cell) { here = here && is_active(levels, place_near(levels, n, cell)); });
            if (here) continue;
            for_leaf_cells(refinement, bounds, level, [&](const grid::CellKey& key) {
                if (grid::active_slot(levels, key.level, key.cell) < 0) found[n].push_back(key);
            });
        }
        grid::sort_unique(found[n]);
    });
    std::vector<grid::CellKey> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    grid::sort_unique(all);
    return all;
}
} // namespace

void refine_voids(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                  grid::Refinement& refinement)
{
    if (!uses_boxes(options)) return;
    for (int round = 1; round < levels.count; ++round) {
        std::vector<grid::CellKey> coarse = too_coarse(options, levels, particles, refinement);
        if (!coarse.empty()) drop_occupied(levels, particles, refinement, coarse);
        if (coarse.empty()) return;
        for (const grid::CellKey& key : coarse) refinement.subdivide(key.level, key.cell);
        refinement.balance();
    }
}

void cover_boxes(const PassOptions& options, const grid::Refinement& refinement, const particles::Particles& particles,
                 grid::Levels& levels)
{
    if (!uses_boxes(options)) return;
    std::vector<grid::CellKey> more = missing(options, refinement, particles, levels);
    if (more.empty()) return;
    const std::vector<grid::Leaf> leaves = levels.leaves;
    const std::vector<std::uint32_t> start = levels.cell_start;
    const std::vector<grid::CellKey> active = grid::active_cells(levels);
    more.insert(more.end(), active.begin(), active.end());
    grid::build(more, levels);
    // More leaves, the same order: only the numbers of the old ones change, and new ones hold nobody.
    levels.cell_start.assign(levels.leaves.size() * grid::leaf_cells + 1, 0);
    for (std::size_t n = 0; n < leaves.size(); ++n) {
        const auto now = static_cast<std::size_t>(grid::leaf_of(levels, leaves[n].level, leaves[n].origin));
        for (std::size_t c = 0; c < grid::leaf_cells; ++c)
            levels.cell_start[now * grid::leaf_cells + c + 1] =
                start[n * grid::leaf_cells + c + 1] - start[n * grid::leaf_cells + c];
    }
    for (std::size_t s = 1; s < levels.cell_start.size(); ++s) levels.cell_start[s] += levels.cell_start[s - 1];
}
} // namespace transfer
