#include "core/parallel.h"
#include "transfer/gimp_gather.h"
#include "transfer/gimp_momentum.h"
#include "transfer/gimp_passes.h"

#include <algorithm>

namespace transfer
{
namespace
{
/// New velocities (and affine matrices) of the particles [begin, begin + count).
template <Transfer T>
void update_velocity(const BoxCutter& cutter, std::size_t begin, int count, std::size_t leaf, BoxParts& parts,
                     particles::Particles& particles)
{
    BoxChunk chunk;
    constexpr BoxWant want = T == Transfer::apic ? BoxWant::affine : BoxWant::slopes;
    gather_boxes<want>(cutter, particles, begin, count, leaf, parts, chunk);
    const Lanes pic(cutter.options.pic_fraction);
    for (std::size_t a = 0; a < 3; ++a) {
        const Lanes grid_velocity = Lanes::load(chunk.value[a]);
        Lanes fresh = grid_velocity;
        if constexpr (T == Transfer::flip) {
            fresh = load(particles.velocity[a], begin, count) + Lanes::load(chunk.value[change_column + a]);
            if (cutter.options.pic_fraction > 0) fresh += pic * (grid_velocity - fresh);
        }
        store(fresh, particles.velocity[a], begin, count);
    }
    if constexpr (T == Transfer::apic)
        for (std::size_t n = 0; n < 9; ++n) store(Lanes::load(chunk.affine[n]), particles.affine[n], begin, count);
}

template <Transfer T>
void remap_residents(const BoxCutter& cutter, std::size_t leaf, particles::Particles& particles, grid::Levels& levels)
{
    grid::NodeSum* tile = levels.sums(leaf);
    for (int i = 0; i < grid::tile_nodes; ++i) tile[i].momentum = {};
    clear_affine<T>(leaf, levels);
    const std::size_t end = levels.cell_start[(leaf + 1) * grid::leaf_cells];
    BoxParts parts;
    for (std::size_t p = levels.cell_start[leaf * grid::leaf_cells]; p < end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, end - p));
        update_velocity<T>(cutter, p, count, leaf, parts, particles);
        BoxStage stage;
        stage_momentum<T>(particles, p, count, stage);
        stage.turn();
        for (int i = 0; i < count; ++i) {
            cutter.cut(particles, p + static_cast<std::size_t>(i), leaf, parts);
            add_to_leaf<T>(cutter, parts, stage.of(i), leaf, levels);
        }
    }
}

template <Transfer T>
void remap_with(const BoxCutter& cutter, const Visits& visits, particles::Particles& particles, grid::Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) { remap_residents<T>(cutter, n, particles, levels); });
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        BoxParts parts;
        for (std::uint32_t v = visits.start[n]; v < visits.start[n + 1]; ++v) {
            BoxStage stage;
            stage_momentum<T>(particles, visits.particle[v], 1, stage);
            stage.turn();
            cutter.cut(particles, visits.particle[v], visits.home[v], parts);
            add_to_leaf<T>(cutter, parts, stage.of(0), n, levels);
        }
    });
}
} // namespace

void remap_boxes(const PassOptions& options, const Strays& strays, particles::Particles& particles,
                 grid::Levels& levels)
{
    const BoxCutter cutter(options, levels, strays.refinement);
    options.transfer == Transfer::apic ? remap_with<Transfer::apic>(cutter, strays.visits, particles, levels)
                                       : remap_with<Transfer::flip>(cutter, strays.visits, particles, levels);
}
} // namespace transfer
