/// Both halves of a step for a plain cell, whose particles are at home, of one law and without decohesion state: grid
/// to particles, material, particles to grid. What the first half computes goes to the second in registers, no particle
/// is asked for anything; the arithmetic is that of advance_cell and scatter_cell, and so are the bits.
#pragma once

#include "transfer/advance_cell.h"
#include "transfer/scatter_cell.h"

namespace transfer
{
/// Advance the particles [begin, end), and add them to the leaf's sums.
/// @pre is_plain(particles, begin, end)
template <Formulation F, Transfer T, StressUpdate S>
[[gnu::noinline]] void advance_plain(const PassOptions& options, const LawTable& laws, const CellFrame& frame,
                                     const grid::NodeMotion* motion, std::size_t begin, std::size_t end,
                                     particles::Particles& particles, LeafOutcome& outcome, grid::NodeSum* sums)
{
    constexpr int width = Lanes::lanes;
    const std::size_t count = plain_count(begin, end), chunks = count / Lanes::lanes;
    CellField field;
    read_cell(motion + frame.node, field);
    detail::Kinematics k[largest_plain / Lanes::lanes];
    Given given[largest_plain / Lanes::lanes];
    const std::size_t leavers = outcome.leaver.size();
    Real volume = 0;
    Real dilated = 0;
    for (std::size_t c = 0; c < chunks; ++c) {
        detail::move<F, T, S, true>(options, laws, frame, Visitors::residents, field, begin + c * width, width,
                                    particles, outcome, k[c], given[c]);
        volume += core::sum(core::select(k[c].averaged, k[c].volume, Lanes(Real(0))));
        dilated += core::sum(core::select(k[c].averaged, k[c].volume * k[c].dilatation, Lanes(Real(0))));
    }
    const Real mean_dilatation = volume > 0 ? dilated / volume : Real(0);
    bool near_onset = false;
    CellPressure pressure;
    for (std::size_t c = 0; c < chunks; ++c) {
        given[c].stress = detail::update_stress<true>(options, laws, frame.per_spacing, k[c], mean_dilatation,
                                                      begin + c * width, width, particles, outcome);
        near_onset = near_onset || (laws.any_decohesion && core::any(k[c].may_start));
        if constexpr (F == Formulation::updated) add_pressure(given[c], k[c].averaged, pressure);
    }
    if (near_onset) detail::test_onset(options, laws, frame, k, begin, end, particles, outcome.onset);
    if (outcome.leaver.size() != leavers) // those are added to the cell they have come to
        return scatter_cell<F, T>(frame, Visitors::residents, laws, particles, begin, end, sums);
    Staged<largest_plain> staged;
    for (std::size_t c = 0; c < chunks; ++c)
        stage<F>(frame, given[c], k[c].averaged, pressure.mean(), static_cast<int>(c) * width, staged);
    add_staged<F, T, true>(frame, staged, static_cast<int>(count), particles, begin, sums);
}
} // namespace transfer
