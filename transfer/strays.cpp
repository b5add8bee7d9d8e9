#include "transfer/strays.h"

#include "grid/topology.h"
#include "transfer/passes.h"
#include "transfer/scaled_position.h"

#include <algorithm>

namespace transfer
{
namespace
{
struct Placed
{
    std::int32_t leaf, cell;
    std::uint32_t particle;
};

/// Make the empty cell around a point active, at level `target` if that is finer than the leaf cell `key` found there.
/// @return its slot, or -1
std::int64_t opened(const Vec3& scaled, grid::CellKey key, int target, grid::Refinement& refinement,
                    grid::Levels& levels)
{
    const bool finer = key.level < target;
    if (finer) key = {target, grid::cell_at(scaled, target)};
    const std::int64_t slot = grid::activate(key, levels);
    if (slot >= 0 && finer) refinement.subdivide(target - 1, grid::parent(key.cell));
    return slot;
}
} // namespace

bool worth_reordering(const PassOptions& options, const Strays& strays, const particles::Particles& particles)
{
    // Boxes are served alike wherever they are, points one by one once they have left their cell.
    const Real share = uses_boxes(options) ? 0.02 : 0.01;
    return strays.outside || static_cast<Real>(strays.size()) > share * static_cast<Real>(particles.size());
}

void assign(const PassOptions& options, const std::vector<std::uint32_t>& away, const particles::Particles& particles,
            grid::Levels& levels, Strays& strays)
{
    std::vector<Placed> placed;
    strays.outside = false;
    for (const std::uint32_t p : away) {
        const Vec3 x = placed_position(levels, particles.position, particles, p);
        const grid::CellKey key = strays.refinement.locate(x);
        std::int64_t slot = grid::active_slot(levels, key.level, key.cell);
        if (slot < 0 && !uses_boxes(options))
            slot = opened(x, key, particles.target_level[p], strays.refinement, levels);
        if (slot < 0) {
            strays.outside = true; // not placed: the caller reorders before anything reads the list
            continue;
        }
        placed.push_back({static_cast<std::int32_t>(slot / grid::leaf_cells),
                          static_cast<std::int32_t>(slot % grid::leaf_cells), p});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.leaf != b.leaf ? a.leaf < b.leaf : a.particle < b.particle;
    });
    strays.particle.clear();
    strays.leaf.clear();
    strays.cell.clear();
    strays.run.clear();
    for (std::size_t s = 0; s < placed.size(); ++s) {
        if (s == 0 || placed[s].leaf != placed[s - 1].leaf) strays.run.push_back(static_cast<std::uint32_t>(s));
        strays.particle.push_back(placed[s].particle);
        strays.leaf.push_back(placed[s].leaf);
        strays.cell.push_back(placed[s].cell);
    }
    strays.run.push_back(static_cast<std::uint32_t>(placed.size()));
}

void assign_all(const PassOptions& options, const particles::Particles& particles, grid::Levels& levels, Strays& strays)
{
    strays.refinement = grid::refinement_of_cells(levels);
    std::vector<std::uint32_t> away;
    for (std::uint32_t p = 0; p < particles.away.size(); ++p)
        if (particles.away[p] != 0) away.push_back(p);
    assign(options, away, particles, levels, strays);
}
} // namespace transfer
