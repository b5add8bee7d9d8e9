#include "core/parallel.h"
#include "transfer/advance_plain.h"
#include "transfer/each_stray.h"
#include "transfer/gimp_passes.h"
#include "transfer/interface_affine.h"
#include "transfer/passes.h"
#include "transfer/scatter_leaf.h"

namespace transfer
{
namespace
{
template <class Visit>
void with_stress_update(const PassOptions& options, const Visit& visit)
{
    with_scheme(options, [&]<Formulation F, Transfer T>() {
        options.stress_update == StressUpdate::usl ? visit.template operator()<F, T, StressUpdate::usl>()
                                                   : visit.template operator()<F, T, StressUpdate::musl>();
    });
}

/// Cell by cell: advance, and scatter while the particles are still in the nearest cache. Affine matrices of hanging
/// cells (APIC) are stored when all cells have been advanced: then the scatter comes afterwards.
void advance_leaf(const PassOptions& options, const LawTable& laws, std::size_t leaf, grid::Levels& levels,
                  particles::Particles& particles, LeafOutcome& outcome)
{
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    const LeafFrame frame = leaf_frame(levels, leaf);
    const std::vector<AffineChunk> affine = affine_of_residents(options, levels, leaf, particles);
    const bool at_once = affine.empty();
    if (at_once) clear_sums(leaf, levels);
    with_stress_update(options, [&]<Formulation F, Transfer T, StressUpdate S>() {
        for (int c = 0; c < grid::leaf_cells; ++c) {
            if (start[c] == start[c + 1]) continue;
            const CellFrame cell = cell_frame(frame, c);
            if (at_once && is_plain(particles, start[c], start[c + 1])) {
                advance_plain<F, T, S>(options, laws, cell, levels.motions(leaf), start[c], start[c + 1], particles,
                                       outcome, levels.sums(leaf));
                continue;
            }
            advance_cell<F, T, S>(options, laws, cell, Visitors::residents, levels.motions(leaf), start[c],
                                  start[c + 1], particles, outcome);
            if (at_once) scatter_residents<F, T>(cell, laws, particles, start[c], start[c + 1], levels.sums(leaf));
        }
    });
    if (at_once) return;
    store_affine(affine, particles);
    scatter_leaf(options, laws, particles, leaf, levels);
}

void advance_strays(const PassOptions& options, const LawTable& laws, const Strays& strays, const grid::Levels& levels,
                    particles::Particles& particles, std::vector<LeafOutcome>& outcome)
{
    with_stress_update(options, [&]<Formulation F, Transfer T, StressUpdate S>() {
        for_each_stray(strays, [&](std::uint32_t s, std::size_t leaf, std::uint32_t p) {
            const std::vector<AffineChunk> affine = affine_of_stray(options, levels, strays, s, particles);
            advance_cell<F, T, S>(options, laws, frame_of_stray(levels, strays, s), Visitors::stray,
                                  levels.motions(leaf), p, p + 1, particles, outcome[leaf]);
            store_affine(affine, particles);
        });
    });
}

void add_work(const std::vector<LeafOutcome>& outcome, std::vector<LeafWork>& leaf_work)
{
    for (std::size_t n = 0; n < outcome.size(); ++n) {
        leaf_work[n].plastic += outcome[n].work.plastic;
        leaf_work[n].decohesion += outcome[n].work.decohesion;
    }
}

/// Give every starting particle its entry in the side table, in leaf order.
void record_onsets(const std::vector<LeafOutcome>& outcome, particles::Particles& particles)
{
    for (const LeafOutcome& leaf : outcome)
        for (const Onset& onset : leaf.onset) record(onset, particles);
}

/// Who is away from its home cell now; once away, a particle stays a stray until the next ordering.
std::vector<std::uint32_t> all_away(const std::vector<LeafOutcome>& outcome, const Strays& strays)
{
    std::vector<std::uint32_t> away = strays.particle;
    for (const LeafOutcome& leaf : outcome) away.insert(away.end(), leaf.leaver.begin(), leaf.leaver.end());
    return away;
}
} // namespace

void advance_and_scatter(const PassOptions& options, const LawTable& laws, Strays& strays,
                         particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work)
{
    std::vector<LeafOutcome> outcome(levels.leaves.size());
    if (uses_boxes(options)) {
        advance_boxes(options, laws, strays, particles, levels, outcome);
        add_work(outcome, leaf_work);
        record_onsets(outcome, particles);
        assign(options, all_away(outcome, strays), particles, levels, strays);
        return finish_boxes(options, laws, outcome, strays, particles, levels);
    }
    // Strays first: they still need the motion tiles, and a leaf's scatter must see only particles at home.
    advance_strays(options, laws, strays, levels, particles, outcome);
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        advance_leaf(options, laws, n, levels, particles, outcome[n]);
        scatter_affine(options, particles, n, levels);
    });
    add_work(outcome, leaf_work);
    record_onsets(outcome, particles);
    if (options.formulation == Formulation::updated) {
        // A cracked particle leaves its cell's mean pressure: its leaf's sums, made while it was intact, are out of
        // date.
        core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
            if (!outcome[n].onset.empty()) scatter_leaf(options, laws, particles, n, levels);
        });
        assign(options, all_away(outcome, strays), particles, levels, strays);
        scatter_strays(options, laws, strays, particles, levels);
        scatter_stray_affine(options, strays, particles, levels);
    }
}
} // namespace transfer
