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
/// Someone whose box reaches into another leaf.
struct Visitor
{
    std::int32_t leaf; // where to
    std::uint32_t particle;
    Real mean_pressure;
};

/// What a leaf's own loop leaves for the others.
struct Outgoing
{
    std::vector<Visitor> visitor;
    bool outside = false;
};

/// Mass, momentum and V sigma of a chunk, with the mean pressure of its home cell for those that take part in it.
template <Transfer T>
void stage_boxes(const LawTable& laws, Real mean_pressure, const particles::Particles& particles, std::size_t begin,
                 int count, BoxStage& stage)
{
    stage_momentum<T>(particles, begin, count, stage);
    load(particles.mass, begin, count).store(stage.row[0][0]);
    Lanes volume = load(particles.rest_volume, begin, count);
    if (laws.any_decohesion && !particles.cracks.empty()) detail::reduce_to_solid(particles, begin, count, volume);
    volume *= load(particles.volume_ratio, begin, count);
    const LaneMask averaged = law_lanes(laws, particles, begin, count).averaged & intact(particles, begin, count) &
                              present<Formulation::updated>(Visitors::residents, particles, begin, count);
    const auto stress = load_all<core::Sym<Lanes>>(particles.stress, begin, count);
    const core::Mat<Lanes> flux = detail::volume_stress(volume, stress, averaged, mean_pressure);
    for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) flux(a, b).store(stage.row[1 + b][4 + a]);
    stage.turn();
}

void note_visits(const BoxParts& parts, std::size_t home, std::size_t p, Real mean_pressure, Outgoing& outgoing)
{
    const std::size_t before = outgoing.visitor.size();
    for (const BoxPart& part : parts.part) {
        if (part.leaf == static_cast<std::int32_t>(home)) continue;
        const auto known = [&](const Visitor& v) { return v.leaf == part.leaf; };
        if (std::any_of(outgoing.visitor.begin() + static_cast<std::ptrdiff_t>(before), outgoing.visitor.end(), known))
            continue;
        outgoing.visitor.push_back({part.leaf, static_cast<std::uint32_t>(p), mean_pressure});
    }
    outgoing.outside = outgoing.outside || parts.outside;
}

template <Transfer T>
void scatter_residents(const BoxCutter& cutter, const LawTable& laws, const particles::Particles& particles,
                       std::size_t leaf, grid::Levels& levels, Outgoing& outgoing)
{
    grid::NodeSum* tile = levels.sums(leaf);
    std::fill(tile, tile + grid::tile_nodes, grid::NodeSum{});
    clear_affine<T>(leaf, levels);
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    BoxParts parts;
    for (int c = 0; c < grid::leaf_cells; ++c) {
        if (start[c] == start[c + 1]) continue;
        CellPressure pressure;
        add_pressure(Visitors::residents, laws, particles, start[c], start[c + 1], pressure);
        for (std::size_t p = start[c]; p < start[c + 1]; p += Lanes::lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, start[c + 1] - p));
            BoxStage stage;
            stage_boxes<T>(laws, pressure.mean(), particles, p, count, stage);
            for (int i = 0; i < count; ++i) {
                const std::size_t q = p + static_cast<std::size_t>(i);
                cutter.cut(particles, q, leaf, parts);
                add_to_leaf<T>(cutter, parts, stage.of(i), leaf, levels);
                note_visits(parts, leaf, q, pressure.mean(), outgoing);
            }
        }
    }
}

/// Visitors of every leaf, in the order of the leaves they come from.
void sort_visits(const std::vector<Outgoing>& outgoing, Visits& visits)
{
    visits.start.assign(outgoing.size() + 1, 0);
    for (const Outgoing& from : outgoing)
        for (const Visitor& v : from.visitor) ++visits.start[static_cast<std::size_t>(v.leaf) + 1];
    for (std::size_t n = 0; n < outgoing.size(); ++n) visits.start[n + 1] += visits.start[n];
    visits.particle.resize(visits.start.back());
    visits.home.resize(visits.start.back());
    visits.mean_pressure.resize(visits.start.back());
    std::vector<std::uint32_t> next(visits.start.begin(), visits.start.end() - 1);
    for (std::size_t n = 0; n < outgoing.size(); ++n)
        for (const Visitor& v : outgoing[n].visitor) {
            const std::uint32_t place = next[static_cast<std::size_t>(v.leaf)]++;
            visits.particle[place] = v.particle;
            visits.home[place] = static_cast<std::uint32_t>(n);
            visits.mean_pressure[place] = v.mean_pressure;
        }
}

template <Transfer T>
void scatter_visitors(const BoxCutter& cutter, const LawTable& laws, const Visits& visits,
                      const particles::Particles& particles, std::size_t leaf, grid::Levels& levels)
{
    BoxParts parts;
    for (std::uint32_t v = visits.start[leaf]; v < visits.start[leaf + 1]; ++v) {
        const std::size_t p = visits.particle[v];
        BoxStage stage;
        stage_boxes<T>(laws, visits.mean_pressure[v], particles, p, 1, stage);
        cutter.cut(particles, p, visits.home[v], parts);
        add_to_leaf<T>(cutter, parts, stage.of(0), leaf, levels);
    }
}

template <Transfer T>
void scatter_with(const BoxCutter& cutter, const LawTable& laws, const particles::Particles& particles,
                  grid::Levels& levels, Strays& strays)
{
    std::vector<Outgoing> outgoing(levels.leaves.size());
    core::parallel_for(outgoing.size(),
                       [&](std::size_t n) { scatter_residents<T>(cutter, laws, particles, n, levels, outgoing[n]); });
    for (const Outgoing& from : outgoing) strays.outside = strays.outside || from.outside;
    sort_visits(outgoing, strays.visits);
    core::parallel_for(outgoing.size(),
                       [&](std::size_t n) { scatter_visitors<T>(cutter, laws, strays.visits, particles, n, levels); });
}
} // namespace

void scatter_boxes(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                   grid::Levels& levels, Strays& strays)
{
    const BoxCutter cutter(options, levels, strays.refinement);
    options.transfer == Transfer::apic ? scatter_with<Transfer::apic>(cutter, laws, particles, levels, strays)
                                       : scatter_with<Transfer::flip>(cutter, laws, particles, levels, strays);
}
} // namespace transfer
