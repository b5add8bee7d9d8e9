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
/// What the boxes of one leaf are added to.
struct BoxTarget
{
    const BoxCutter& cutter;
    const ReachMap& map;
    const BoxFrame& frame;
    ReachTile<grid::NodeSum>& tile;
    CutBoxes& cut;
};

/// Mass, momentum and V sigma of a chunk, with the mean pressure of its home cell on `averaged` lanes.
template <Transfer T>
[[gnu::always_inline]] inline BoxRows<T> gifts_of(const Given& given, LaneMask averaged, Real mean_pressure,
                                                  const particles::Particles& particles, std::size_t begin, int count)
{
    BoxRows<T> rows(BoxGive::all);
    stage_momentum<T>(particles, begin, count, given.mass, given.velocity, rows);
    rows.mass() = given.mass;
    const core::Sym<Lanes> flux = detail::volume_stress(given.volume, given.stress, averaged, mean_pressure);
    for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) rows.flux(a, b) = -flux(a, b);
    return rows;
}

/// Cut the box of particle p and keep it with what it gives.
[[gnu::noinline]] void keep_cut(const BoxCutter& cutter, const particles::Particles& particles, std::size_t p,
                                const BoxGift& gift, CutBoxes& cut)
{
    cut.gift.push_back(gift);
    if (!cutter.cut(particles, p, cut.part)) cut.outside = true;
    cut.part_start.push_back(static_cast<std::uint32_t>(cut.part.size()));
}

/// Add a chunk to the sums in reach.
template <Transfer T>
[[gnu::always_inline]] inline void add_chunk(const BoxTarget& target, const Given& given, LaneMask averaged,
                                             Real mean_pressure, const particles::Particles& particles,
                                             std::size_t begin, int count)
{
    BoxWeights weights;
    box_weights<T == Transfer::apic>(target.frame, box_axes(target.frame, particles, begin, count), weights);
    const BoxStage<T> stage(gifts_of<T>(given, averaged, mean_pressure, particles, begin, count));
    add_boxes<T, BoxGive::all>(target.map, weights, count, stage, target.tile, [&](int i) {
        keep_cut(target.cutter, particles, begin + static_cast<std::size_t>(i), stage.gift(i), target.cut);
    });
}

/// Particles of a plain cell: each column is read once.
template <Transfer T>
void add_plain(const BoxTarget& target, const LawTable& laws, const particles::Particles& particles, std::size_t begin,
               std::size_t end)
{
    const std::size_t chunks = plain_count(begin, end) / Lanes::lanes;
    constexpr int width = Lanes::lanes;
    Given given[largest_plain / Lanes::lanes];
    CellPressure pressure;
    const LaneMask averaged = law_lanes<true>(laws, particles, begin, width).averaged;
    for (std::size_t c = 0; c < chunks; ++c) {
        given[c] = read_given<Formulation::updated>(particles, begin + c * width, width);
        add_pressure(given[c], averaged, pressure);
    }
    for (std::size_t c = 0; c < chunks; ++c)
        add_chunk<T>(target, given[c], averaged, pressure.mean(), particles, begin + c * width, width);
}

template <Transfer T>
void add_any(const BoxTarget& target, const LawTable& laws, const particles::Particles& particles, std::size_t begin,
             std::size_t end)
{
    for (std::size_t first = begin; first < end; first += group_size<false>) {
        const std::size_t last = std::min(end, first + group_size<false>);
        const CellPressure pressure = pressure_of(Visitors::residents, laws, particles, first, last);
        for (std::size_t p = first; p < last; p += Lanes::lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, last - p));
            Given given = read_given<Formulation::updated>(particles, p, count);
            if (laws.any_decohesion && !particles.cracks.empty())
                detail::reduce_to_solid(particles, p, count, given.volume);
            const LaneMask averaged = pressure_lanes(laws, particles, p, count) &
                                      present<Formulation::updated>(Visitors::residents, particles, p, count);
            add_chunk<T>(target, given, averaged, pressure.mean(), particles, p, count);
        }
    }
}

void clear(CutBoxes& cut)
{
    cut.part_start.assign(1, 0);
    cut.part.clear();
    cut.gift.clear();
    cut.outside = false;
}

template <Transfer T>
void scatter_leaf_with(const PassOptions& options, const LawTable& laws, const grid::Refinement& refinement,
                       const particles::Particles& particles, std::size_t leaf, const ReachMap& map,
                       grid::Levels& levels, Boxes& boxes)
{
    const BoxCutter cutter{options, levels, refinement};
    clear(boxes.cut[leaf]);
    if constexpr (T == Transfer::apic) clear_affine(leaf, levels);
    ReachTile<grid::NodeSum> tile;
    clear(map, tile);
    const BoxFrame frame = box_frame(options, levels, leaf);
    const BoxTarget target{cutter, map, frame, tile, boxes.cut[leaf]};
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    for (int c = 0; c < grid::leaf_cells; ++c) {
        if (start[c] == start[c + 1]) continue;
        if (is_plain(particles, start[c], start[c + 1]))
            add_plain<T>(target, laws, particles, start[c], start[c + 1]);
        else
            add_any<T>(target, laws, particles, start[c], start[c + 1]);
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
    options.transfer == Transfer::apic
        ? scatter_leaf_with<Transfer::apic>(options, laws, refinement, particles, leaf, map, levels, boxes)
        : scatter_leaf_with<Transfer::flip>(options, laws, refinement, particles, leaf, map, levels, boxes);
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
        for (std::size_t box = 0; box < cut.gift.size(); ++box)
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
