#include "transfer/strays.h"

#include "core/error.h"
#include "grid/topology.h"
#include "transfer/scaled_position.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace transfer
{
namespace
{
struct Placed
{
    std::int32_t leaf, cell;
    std::uint32_t particle;
};

/// A position that is a number, or an error that names the particle.
Vec3 finite_position(const particles::Particles& particles, const grid::Levels& levels, std::uint32_t p)
{
    const Vec3 x = scaled_position(levels, particles.position, p);
    if (!x.allFinite())
        throw core::NumericalError("particle " + std::to_string(particles.id[p]) +
                                   " has no finite position: the computation is unstable (smaller numerics.cfl?)");
    return x;
}
} // namespace

bool worth_reordering(const Strays& strays, const particles::Particles& particles)
{
    return strays.outside || static_cast<Real>(strays.size()) > reorder_share * static_cast<Real>(particles.size());
}

void assign(const std::vector<std::uint32_t>& away, const particles::Particles& particles, const grid::Levels& levels,
            Strays& strays)
{
    std::vector<Placed> placed;
    strays.outside = false;
    for (const std::uint32_t p : away) {
        const grid::CellKey key = strays.refinement.locate(finite_position(particles, levels, p));
        const std::int32_t leaf = grid::leaf_of(levels, key.level, key.cell);
        if (leaf < 0) {
            strays.outside = true; // not placed: the caller reorders before anything reads the list
            continue;
        }
        const Index3 local = key.cell - levels.leaves[static_cast<std::size_t>(leaf)].origin;
        const std::int32_t cell = grid::cell_index(local[0], local[1], local[2]);
        const std::size_t slot = static_cast<std::size_t>(leaf) * grid::leaf_cells + static_cast<std::size_t>(cell);
        if (levels.cell_active[slot] == 0) strays.outside = true;
        placed.push_back({leaf, cell, p});
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

void assign_all(const particles::Particles& particles, const grid::Levels& levels, Strays& strays)
{
    std::vector<std::uint32_t> away;
    for (std::uint32_t p = 0; p < particles.away.size(); ++p)
        if (particles.away[p] != 0) away.push_back(p);
    assign(away, particles, levels, strays);
}
} // namespace transfer
