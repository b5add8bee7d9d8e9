#include "transfer/scatter_leaf.h"

#include "core/parallel.h"
#include "grid/walls.h"
#include "transfer/each_stray.h"
#include "transfer/scatter_cell.h"

namespace transfer
{
void clear_sums(std::size_t leaf, grid::Levels& levels)
{
    grid::NodeSum* tile = levels.sums(leaf);
    grid::for_nodes(levels.used[leaf], grid::leaf_side, [&](int node) { tile[node] = {}; });
}

template <Formulation F, Transfer T>
void scatter_residents(const CellFrame& frame, const LawTable& laws, const particles::Particles& particles,
                       std::size_t begin, std::size_t end, grid::NodeSum* tile)
{
    scatter_cell<F, T>(frame, Visitors::residents, laws, particles, begin, end, tile);
}

template void scatter_residents<Formulation::total, Transfer::flip>(const CellFrame&, const LawTable&,
                                                                    const particles::Particles&, std::size_t,
                                                                    std::size_t, grid::NodeSum*);
template void scatter_residents<Formulation::total, Transfer::apic>(const CellFrame&, const LawTable&,
                                                                    const particles::Particles&, std::size_t,
                                                                    std::size_t, grid::NodeSum*);
template void scatter_residents<Formulation::updated, Transfer::flip>(const CellFrame&, const LawTable&,
                                                                      const particles::Particles&, std::size_t,
                                                                      std::size_t, grid::NodeSum*);
template void scatter_residents<Formulation::updated, Transfer::apic>(const CellFrame&, const LawTable&,
                                                                      const particles::Particles&, std::size_t,
                                                                      std::size_t, grid::NodeSum*);

void scatter_leaf(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t leaf, grid::Levels& levels)
{
    clear_sums(leaf, levels);
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    const LeafFrame frame = leaf_frame(levels, leaf);
    with_scheme(options, [&]<Formulation F, Transfer T>() {
        for (int c = 0; c < grid::leaf_cells; ++c)
            if (start[c] != start[c + 1])
                scatter_residents<F, T>(cell_frame(frame, c), laws, particles, start[c], start[c + 1],
                                        levels.sums(leaf));
    });
}

void scatter_strays(const PassOptions& options, const LawTable& laws, const Strays& strays,
                    const particles::Particles& particles, grid::Levels& levels)
{
    with_scheme(options, [&]<Formulation F, Transfer T>() {
        for_each_stray(strays, [&](std::uint32_t s, std::size_t leaf, std::uint32_t p) {
            scatter_cell<F, T>(frame_of_stray(levels, strays, s), Visitors::stray, laws, particles, p, p + 1,
                               levels.sums(leaf));
        });
    });
}
} // namespace transfer
