#include "io/grid_cells.h"

#include "core/contract.h"
#include "io/cell_order.h"

#include <algorithm>

namespace io
{
namespace
{
struct Entry
{
    Index3 place;
    std::uint8_t covered = 0;
    std::uint32_t particle = 0;
    std::uint32_t count = 0;
};

/// Cells of one level with particles at home in them.
std::vector<Entry> home_cells(const grid::Levels& levels, int level)
{
    std::vector<Entry> entries;
    const auto l = static_cast<std::size_t>(level);
    for (std::int32_t leaf = levels.level_start[l]; leaf < levels.level_start[l + 1]; ++leaf) {
        const auto n = static_cast<std::size_t>(leaf);
        for (int cell = 0; cell < grid::leaf_cells; ++cell) {
            const std::size_t slot = n * grid::leaf_cells + static_cast<std::size_t>(cell);
            const std::uint32_t begin = levels.cell_start[slot], end = levels.cell_start[slot + 1];
            if (begin == end) continue;
            const Index3 inside(cell / 64, cell / 8 % 8, cell % 8);
            entries.push_back({levels.leaves[n].origin + inside, 0, begin, end - begin});
        }
    }
    return entries;
}

Index3 above(const Index3& place)
{
    return {place.x() >> 1, place.y() >> 1, place.z() >> 1};
}

/// Add the coarser cells that `finer` fills: all eight cells below them are there.
void add_filled(const GridCells& finer, std::vector<Entry>& entries)
{
    std::vector<Index3> places;
    for (const Index3& place : finer.place) places.push_back(above(place));
    std::sort(places.begin(), places.end(), [](const Index3& a, const Index3& b) { return cell_key(a) < cell_key(b); });
    for (std::size_t i = 0; i + 7 < places.size(); ++i)
        if (places[i] == places[i + 7]) entries.push_back({places[i], 1});
}

GridCells columns_of(const std::vector<Entry>& entries)
{
    GridCells cells;
    for (const Entry& entry : entries) {
        cells.place.push_back(entry.place);
        cells.covered.push_back(entry.covered);
        cells.particle.push_back(entry.particle);
        cells.count.push_back(entry.count);
    }
    return cells;
}

std::vector<std::int64_t> parents_of(const GridCells& finer, const GridCells& coarser)
{
    std::vector<std::int64_t> parent;
    for (const Index3& place : finer.place) {
        const std::size_t number = find_cell(coarser.place, above(place));
        const bool there = number < coarser.place.size() && coarser.place[number] == above(place);
        parent.push_back(there ? static_cast<std::int64_t>(number) : -1);
    }
    return parent;
}
} // namespace

std::vector<GridCells> grid_cells(const grid::Levels& levels)
{
    std::vector<GridCells> all(static_cast<std::size_t>(levels.count));
    for (int level = levels.count - 1; level >= 0; --level) {
        const auto l = static_cast<std::size_t>(level);
        std::vector<Entry> entries = home_cells(levels, level);
        if (l + 1 < all.size()) add_filled(all[l + 1], entries);
        std::sort(entries.begin(), entries.end(),
                  [](const Entry& a, const Entry& b) { return cell_key(a.place) < cell_key(b.place); });
        all[l] = columns_of(entries);
        if (l + 1 < all.size()) all[l + 1].parent = parents_of(all[l + 1], all[l]);
    }
    while (all.size() > 1 && all.back().place.empty()) all.pop_back();
    return all;
}

std::vector<std::vector<Real>> sum_over_cells(const std::vector<GridCells>& cells, std::span<const Real> weight,
                                              std::span<const Real> values, int components)
{
    const auto width = static_cast<std::size_t>(components);
    CLEAVE_EXPECTS(values.empty() ? width == 1 : values.size() == weight.size() * width);
    std::vector<std::vector<Real>> sums(cells.size());
    for (std::size_t l = cells.size(); l-- > 0;) {
        sums[l].assign(cells[l].place.size() * width, 0);
        for (std::size_t c = 0; c < cells[l].place.size(); ++c) {
            const std::size_t begin = cells[l].particle[c], end = begin + cells[l].count[c];
            for (std::size_t p = begin; p < end; ++p)
                for (std::size_t i = 0; i < width; ++i)
                    sums[l][c * width + i] += weight[p] * (values.empty() ? 1 : values[p * width + i]);
        }
        if (l + 1 == cells.size()) continue;
        const std::vector<std::int64_t>& parent = cells[l + 1].parent;
        for (std::size_t fine = 0; fine < parent.size(); ++fine)
            for (std::size_t i = 0; i < width && parent[fine] >= 0; ++i)
                sums[l][static_cast<std::size_t>(parent[fine]) * width + i] += sums[l + 1][fine * width + i];
    }
    return sums;
}
} // namespace io
