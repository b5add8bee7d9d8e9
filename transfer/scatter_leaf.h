/// Scatter of whole leaves; separate functions, never inlined into a pass, so that every caller gets the same bits
/// (plain cells have a copy of the arithmetic, advance_plain.h).
#pragma once

#include "transfer/chunk.h"
#include "transfer/passes.h"

namespace transfer
{
/// Zero the leaf's sums.
void clear_sums(std::size_t leaf, grid::Levels& levels);

/// Scatter the particles [begin, end) of one cell that are at home: what scatter_leaf does cell by cell.
template <Formulation F, Transfer T>
void scatter_residents(const CellFrame& frame, const LawTable& laws, const particles::Particles& particles,
                       std::size_t begin, std::size_t end, grid::NodeSum* tile);

/// Zero the leaf's sums and scatter the particles at home in its cells. What hanging corners collect with APIC is
/// another visit (transfer/interface_affine.h).
void scatter_leaf(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t leaf, grid::Levels& levels);

/// Add the strays, each to the tile of the leaf it is in, in particle order.
void scatter_strays(const PassOptions& options, const LawTable& laws, const Strays& strays,
                    const particles::Particles& particles, grid::Levels& levels);

/// Call `visit.template operator()<F, T>()` for the options' formulation and transfer.
template <class Visit>
void with_scheme(const PassOptions& options, const Visit& visit)
{
    using enum Formulation;
    using enum Transfer;
    const bool affine = options.transfer == apic;
    if (options.formulation == total) {
        affine ? visit.template operator()<total, apic>() : visit.template operator()<total, flip>();
    } else {
        affine ? visit.template operator()<updated, apic>() : visit.template operator()<updated, flip>();
    }
}
} // namespace transfer
