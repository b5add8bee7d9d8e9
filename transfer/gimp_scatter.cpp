#include "core/parallel.h"
#include "transfer/gimp_affine.h"
#include "transfer/gimp_momentum.h"
#include "transfer/gimp_passes.h"
#include "transfer/scatter_cell.h"

#include <algorithm>

namespace transfer
{
namespace
{
/// Mass, momentum and V sigma of a chunk, with the mean pressure of its home cell for those that take part in it.
template <Transfer T>
void stage_boxes(const LawTable& laws, Real mean_pressure, const particles::Particles& particles, std::size_t begin,
                 int count, BoxStage<T>& stage)
{
    stage_momentum<T>(particles, begin, count, stage);
    load(particles.mass, begin, count).store(stage.mass());
    Given given = read_given<Formulation::updated>(particles, begin, count);
    if (laws.any_decohesion && !particles.cracks.empty())
        detail::reduce_to_solid(particles, begin, count, given.volume);
    const LaneMask averaged = pressure_lanes(laws, particles, begin, count) &
                              present<Formulation::updated>(Visitors::residents, particles, begin, count);
    const core::Sym<Lanes> flux = detail::volume_stress(given.volume, given.stress, averaged, mean_pressure);
    for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a)
            (-flux(a, b)).store(stage.flux(static_cast<std::size_t>(a), static_cast<std::size_t>(b)));
    stage.turn();
}

/// Cut the box of particle p and keep it with what it gives.
[[gnu::noinline]] void keep_cut(const BoxCutter& cutter, const particles::Particles& particles, std::size_t p,
                                const BoxGift& gift, CutBoxes& cut)
{
    cut.particle.push_back(static_cast<std::uint32_t>(p));
    cut.gift.push_back(gift);
    if (!cutter.cut(particles, p, cut.part)) cut.outside = true;
    cut.part_start.push_back(static_cast<std::uint32_t>(cut.part.size()));
}

void clear(CutBoxes& cut)
{
    cut.particle.clear();
    cut.part_start.assign(1, 0);
    cut.part.clear();
    cut.gift.clear();
    cut.outside = false;
}

template <Transfer T>
void scatter_leaf_with(const BoxCutter& cutter, const LawTable& laws, const particles::Particles& particles,
                       std::size_t leaf, const ReachMap& map, grid::Levels& levels, Boxes& boxes)
{
    CutBoxes& cut = boxes.cut[leaf];
    clear(cut);
    if constexpr (T == Transfer::apic) clear_affine(leaf, levels);
    ReachTile<grid::NodeSum> tile;
    clear(map, tile);
    const BoxFrame frame = box_frame(cutter.options, levels, leaf);
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    for (int c = 0; c < grid::leaf_cells; ++c) {
        if (start[c] == start[c + 1]) continue;
        const CellPressure pressure = pressure_of(Visitors::residents, laws, particles, start[c], start[c + 1]);
        for (std::size_t p = start[c]; p < start[c + 1]; p += Lanes::lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, start[c + 1] - p));
            BoxStage<T> stage(BoxGive::all);
            BoxWeights weights;
            box_weights<T == Transfer::apic>(frame, particles, p, count, weights);
            stage_boxes<T>(laws, pressure.mean(), particles, p, count, stage);
            add_boxes<T, BoxGive::all>(map, weights, count, stage, tile, [&](int i) {
                keep_cut(cutter, particles, p + static_cast<std::size_t>(i), stage.gift(i), cut);
            });
        }
    }
    write_sums(BoxGive::all, leaf, map, tile, levels, boxes);
}
} // namespace

void prepare_boxes(const grid::Levels& levels, Boxes& boxes)
{
    const std::size_t leaves = levels.leaves.size();
    boxes.cut.resize(leaves);
    boxes.reached.resize(leaves);
    boxes.skin.resize(leaves * skin_nodes);
}

void scatter_leaf_boxes(const PassOptions& options, const LawTable& laws, const grid::Refinement& refinement,
                        const particles::Particles& particles, std::size_t leaf, const ReachMap& map,
                        grid::Levels& levels, Boxes& boxes)
{
    const BoxCutter cutter{options, levels, refinement};
    options.transfer == Transfer::apic
        ? scatter_leaf_with<Transfer::apic>(cutter, laws, particles, leaf, map, levels, boxes)
        : scatter_leaf_with<Transfer::flip>(cutter, laws, particles, leaf, map, levels, boxes);
}

void sort_arrivals(Strays& strays)
{
    Boxes& boxes = strays.boxes;
    boxes.start.assign(boxes.cut.size() + 1, 0);
    for (const CutBoxes& cut : boxes.cut) {
        strays.outside = strays.outside || cut.outside;
        for (const BoxPart& part : cut.part) ++boxes.start[static_cast<std::size_t>(part.leaf) + 1];
    }
    for (std::size_t n = 0; n < boxes.cut.size(); ++n) boxes.start[n + 1] += boxes.start[n];
    boxes.arrival.resize(boxes.start.back());
    // The starts move up while the lists fill, to where the next list starts.
    for (std::size_t n = 0; n < boxes.cut.size(); ++n) {
        const CutBoxes& cut = boxes.cut[n];
        for (std::size_t box = 0; box < cut.particle.size(); ++box)
            for (std::uint32_t part = cut.part_start[box]; part < cut.part_start[box + 1]; ++part)
                boxes.arrival[boxes.start[static_cast<std::size_t>(cut.part[part].leaf)]++] = {
                    static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(box), part};
    }
    std::rotate(boxes.start.begin(), boxes.start.end() - 1, boxes.start.end());
    boxes.start.front() = 0;
}

void deliver_boxes(const PassOptions& options, const Boxes& boxes, grid::Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        add_skins(boxes, n, levels);
        for (std::uint32_t a = boxes.start[n]; a < boxes.start[n + 1]; ++a) {
            const Boxes::Arrival& arrival = boxes.arrival[a];
            const CutBoxes& cut = boxes.cut[arrival.home];
            scatter_part(cut.part[arrival.part], cut.gift[arrival.box], levels.sums(n));
            if (options.transfer == Transfer::apic)
                scatter_affine_part(cut.part[arrival.part], cut.gift[arrival.box], levels);
        }
    });
}

void scatter_boxes(const PassOptions& options, const LawTable& laws, Strays& strays,
                   const particles::Particles& particles, grid::Levels& levels)
{
    prepare_boxes(levels, strays.boxes);
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        ReachMap map;
        map_reach(options, levels, n, map);
        scatter_leaf_boxes(options, laws, strays.refinement, particles, n, map, levels, strays.boxes);
    });
    sort_arrivals(strays);
    deliver_boxes(options, strays.boxes, levels);
}
} // namespace transfer
