#include "core/parallel.h"
#include "transfer/advance_cell.h"
#include "transfer/gimp_gather.h"
#include "transfer/gimp_passes.h"

namespace transfer
{
namespace
{
/// Stage one of a chunk.
template <Transfer T, StressUpdate S, bool Plain>
[[gnu::always_inline]] inline void move_boxes(const PassOptions& options, const LawTable& laws, const BoxFrame& frame,
                                              const CellFrame& cell, std::size_t p, int count, BoxSource& source,
                                              particles::Particles& particles, LeafOutcome& outcome,
                                              detail::Kinematics& k)
{
    constexpr BoxRead read = S == StressUpdate::musl ? BoxRead::change_slopes
                             : T == Transfer::apic   ? BoxRead::affine
                                                     : BoxRead::velocity_slopes;
    BoxChunk chunk;
    gather_boxes<read>(frame, particles, p, count, source, chunk);
    const auto x = load_all<core::Vec<Lanes>>(particles.position, p, count);
    k.here = present<Formulation::updated, Plain>(Visitors::everyone, particles, p, count);
    const core::Vec<Lanes> velocity{
        {Lanes::load(chunk.value[0]), Lanes::load(chunk.value[1]), Lanes::load(chunk.value[2])}};
    core::Mat<Lanes> gradient = matrix_lanes(chunk.gradient);
    core::Mat<Lanes> affine;
    if constexpr (read == BoxRead::affine) affine = matrix_lanes(chunk.affine);
    Given given; // the scatter reads the columns
    const auto change = [&](int a) { return Lanes::load(chunk.value[change_column + a]); };
    detail::carry<Formulation::updated, T, S, Plain>(options, laws, cell,
                                                     Plain ? Visitors::residents : Visitors::everyone, x, velocity,
                                                     gradient, affine, change, p, count, particles, outcome, k, given);
}

template <Transfer T, StressUpdate S>
void advance_leaf(const PassOptions& options, const LawTable& laws, std::size_t leaf, const ReachMap& map,
                  const grid::Levels& levels, const Boxes& boxes, particles::Particles& particles, LeafOutcome& outcome)
{
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    const LeafFrame leaf_of_cells = leaf_frame(levels, leaf);
    const BoxFrame frame = box_frame(options, levels, leaf);
    ReachTile<grid::NodeMotion> tile;
    read_motion(levels, leaf, map, tile);
    BoxSource source{levels, map, tile.node, boxes.cut[leaf]};
    for (int c = 0; c < grid::leaf_cells; ++c) {
        if (start[c] == start[c + 1]) continue;
        const CellFrame cell = cell_frame(leaf_of_cells, c);
        const auto advance = [&]<bool Plain>() {
            advance_group<Plain>(
                options, laws, cell, start[c], start[c + 1], particles,
                outcome, [&](std::size_t p, int count, detail::Kinematics& k) __attribute__((always_inline)) {
                    move_boxes<T, S, Plain>(options, laws, frame, cell, p, count, source, particles, outcome, k);
                });
        };
        is_plain(particles, start[c], start[c + 1]) ? advance.template operator()<true>()
                                                    : advance.template operator()<false>();
    }
}

template <Transfer T, StressUpdate S>
void advance_with(const PassOptions& options, const LawTable& laws, Strays& strays, particles::Particles& particles,
                  grid::Levels& levels, std::vector<LeafOutcome>& outcome)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        ReachMap map;
        map_reach(options, levels, n, map);
        advance_leaf<T, S>(options, laws, n, map, levels, strays.boxes, particles, outcome[n]);
        scatter_leaf_boxes(options, laws, strays.refinement, particles, n, map, levels, strays.boxes);
    });
}
} // namespace

void advance_boxes(const PassOptions& options, const LawTable& laws, Strays& strays, particles::Particles& particles,
                   grid::Levels& levels, std::vector<LeafOutcome>& outcome)
{
    using enum Transfer;
    using enum StressUpdate;
    if (options.transfer == apic)
        options.stress_update == usl ? advance_with<apic, usl>(options, laws, strays, particles, levels, outcome)
                                     : advance_with<apic, musl>(options, laws, strays, particles, levels, outcome);
    else
        options.stress_update == usl ? advance_with<flip, usl>(options, laws, strays, particles, levels, outcome)
                                     : advance_with<flip, musl>(options, laws, strays, particles, levels, outcome);
}

void finish_boxes(const PassOptions& options, const LawTable& laws, const std::vector<LeafOutcome>& outcome,
                  Strays& strays, const particles::Particles& particles, grid::Levels& levels)
{
    // A cracked particle leaves its cell's mean pressure: its leaf's sums, made while it was intact, are out of date.
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        if (outcome[n].onset.empty()) return;
        ReachMap map;
        map_reach(options, levels, n, map);
        scatter_leaf_boxes(options, laws, strays.refinement, particles, n, map, levels, strays.boxes);
    });
    sort_arrivals(strays);
    deliver_boxes(options, strays.boxes, levels);
}
} // namespace transfer
