#include "core/parallel.h"
#include "transfer/advance_cell.h"
#include "transfer/gimp_gather.h"
#include "transfer/gimp_passes.h"

namespace transfer
{
namespace
{
template <Transfer T, StressUpdate S>
void advance_leaf(const BoxCutter& cutter, const LawTable& laws, std::size_t leaf, const grid::Levels& levels,
                  particles::Particles& particles, LeafOutcome& outcome)
{
    constexpr bool last = S == StressUpdate::usl;
    constexpr BoxWant want = last && T == Transfer::apic ? BoxWant::affine : BoxWant::slopes;
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    const LeafFrame frame = leaf_frame(levels, leaf);
    BoxParts parts;
    for (int c = 0; c < grid::leaf_cells; ++c) {
        if (start[c] == start[c + 1]) continue;
        const CellFrame cell = cell_frame(frame, c);
        const auto move = [&](std::size_t p, int count, detail::Kinematics& k) {
            BoxChunk chunk;
            gather_boxes<want>(cutter, particles, p, count, leaf, parts, chunk);
            const auto x = load_all<core::Vec<Lanes>>(particles.position, p, count);
            k.here = present<Formulation::updated>(Visitors::everyone, particles, p, count);
            const core::Vec<Lanes> velocity{
                {Lanes::load(chunk.value[0]), Lanes::load(chunk.value[1]), Lanes::load(chunk.value[2])}};
            core::Mat<Lanes> gradient = gradient_lanes(chunk, last ? velocity_column : change_column);
            core::Mat<Lanes> affine;
            if constexpr (want == BoxWant::affine) affine = affine_lanes(chunk);
            const auto change = [&](int a) { return Lanes::load(chunk.value[change_column + a]); };
            detail::carry<Formulation::updated, T, S>(cutter.options, laws, cell, Visitors::everyone, x, velocity,
                                                      gradient, affine, change, p, count, particles, outcome, k);
        };
        advance_group(cutter.options, laws, cell, start[c], start[c + 1], particles, outcome, move);
    }
}

template <Transfer T, StressUpdate S>
void advance_with(const BoxCutter& cutter, const LawTable& laws, const grid::Levels& levels,
                  particles::Particles& particles, std::vector<LeafOutcome>& outcome)
{
    core::parallel_for(levels.leaves.size(),
                       [&](std::size_t n) { advance_leaf<T, S>(cutter, laws, n, levels, particles, outcome[n]); });
}
} // namespace

void advance_boxes(const PassOptions& options, const LawTable& laws, const Strays& strays, const grid::Levels& levels,
                   particles::Particles& particles, std::vector<LeafOutcome>& outcome)
{
    using enum Transfer;
    using enum StressUpdate;
    const BoxCutter cutter(options, levels, strays.refinement);
    if (options.transfer == apic)
        options.stress_update == usl ? advance_with<apic, usl>(cutter, laws, levels, particles, outcome)
                                     : advance_with<apic, musl>(cutter, laws, levels, particles, outcome);
    else
        options.stress_update == usl ? advance_with<flip, usl>(cutter, laws, levels, particles, outcome)
                                     : advance_with<flip, musl>(cutter, laws, levels, particles, outcome);
}
} // namespace transfer
