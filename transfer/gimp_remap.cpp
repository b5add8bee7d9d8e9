#include "core/parallel.h"
#include "transfer/flip.h"
#include "transfer/gimp_gather.h"
#include "transfer/gimp_momentum.h"
#include "transfer/gimp_passes.h"

#include <algorithm>

namespace transfer
{
namespace
{
/// What the boxes of the particles [begin, begin + count) read, and their weights.
template <BoxRead Read>
void read_boxes(const BoxFrame& frame, const particles::Particles& particles, std::size_t begin, int count,
                BoxSource& source, BoxChunk& chunk, BoxWeights& weights)
{
    constexpr bool affine = Read == BoxRead::affine;
    const BoxAxes axes = box_axes(frame, particles, begin, count);
    box_weights<affine>(frame, axes, weights);
    SharedBoxes shared;
    if (share_cells<affine>(source.map, frame, axes, count, shared))
        gather_together<Read>(shared, source, chunk);
    else
        gather_each<Read>(weights, count, source, chunk);
}

/// New velocities (and affine matrices) of the particles [begin, begin + count).
template <Transfer T>
void update_velocity(const PassOptions& options, const BoxChunk& chunk, std::size_t begin, int count,
                     particles::Particles& particles)
{
    for (std::size_t a = 0; a < 3; ++a) {
        const Lanes grid_velocity = Lanes::load(chunk.value[a]);
        Lanes fresh = grid_velocity;
        if constexpr (T == Transfer::flip) {
            const Lanes old = load(particles.velocity[a], begin, count);
            fresh =
                flip_velocity(options.pic_fraction, old, Lanes::load(chunk.value[change_column + a]), grid_velocity);
        }
        store(fresh, particles.velocity[a], begin, count);
    }
    if constexpr (T == Transfer::apic)
        for (std::size_t n = 0; n < 9; ++n) store(Lanes::load(chunk.affine[n]), particles.affine[n], begin, count);
}

template <Transfer T>
void remap_leaf(const PassOptions& options, std::size_t leaf, particles::Particles& particles, grid::Levels& levels,
                Boxes& boxes)
{
    if constexpr (T == Transfer::apic) clear_affine(leaf, levels);
    ReachMap map;
    map_reach(options, levels, leaf, map);
    ReachTile<grid::NodeMotion> motion;
    read_motion(levels, leaf, map, motion);
    ReachTile<grid::NodeSum> tile;
    clear(map, tile);
    const BoxFrame frame = box_frame(options, levels, leaf);
    CutBoxes& cut = boxes.cut[leaf];
    BoxSource source{levels, map, motion.node, cut};
    std::size_t given = 0; // cut boxes whose gift is up to date
    const std::size_t end = levels.cell_start[(leaf + 1) * grid::leaf_cells];
    for (std::size_t p = levels.cell_start[leaf * grid::leaf_cells]; p < end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, end - p));
        BoxChunk chunk;
        BoxWeights weights;
        read_boxes<T == Transfer::apic ? BoxRead::affine : BoxRead::values>(frame, particles, p, count, source, chunk,
                                                                            weights);
        update_velocity<T>(options, chunk, p, count, particles);
        BoxRows<T> rows(BoxGive::momentum);
        stage_momentum<T>(particles, p, count, load(particles.mass, p, count),
                          load_all<core::Vec<Lanes>>(particles.velocity, p, count), rows);
        const BoxStage<T> stage(rows);
        add_boxes<T, BoxGive::momentum>(map, weights, count, stage, tile,
                                        [&](int i) { cut.gift[given++] = stage.gift(i); });
    }
    write_sums(BoxGive::momentum, leaf, map, tile, levels, boxes);
}

template <Transfer T>
void remap_with(const PassOptions& options, Boxes& boxes, particles::Particles& particles, grid::Levels& levels)
{
    core::parallel_for(levels.leaves.size(),
                       [&](std::size_t n) { remap_leaf<T>(options, n, particles, levels, boxes); });
}
} // namespace

void remap_boxes(const PassOptions& options, Strays& strays, particles::Particles& particles, grid::Levels& levels)
{
    options.transfer == Transfer::apic ? remap_with<Transfer::apic>(options, strays.boxes, particles, levels)
                                       : remap_with<Transfer::flip>(options, strays.boxes, particles, levels);
    deliver_boxes(options, strays.boxes, levels);
}
} // namespace transfer
