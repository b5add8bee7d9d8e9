/// APIC where levels meet: a second visit to the particles in cells with hanging corners, so that the passes over all
/// other cells know nothing of it (methods.md A.3.5; formulas in grid/hanging.h and transfer/hanging_cell.h).
#pragma once

#include "transfer/hanging_cell.h"
#include "transfer/passes.h"

#include <vector>

namespace transfer
{
/// New affine matrices of up to `Lanes::lanes` particles.
struct AffineChunk
{
    std::size_t begin;
    int count;
    LaneMask here;
    core::Mat<Lanes> affine; // 1/ms
};

/// New affine matrices of the residents of a leaf's hanging cells, from the nodal velocity at their present positions.
/// The particles are not touched: `advance_cell` would overwrite the matrices, and it moves positions. Empty unless
/// APIC, and with a second mapping (MUSL), where remap_momentum has made the matrices.
std::vector<AffineChunk> affine_of_residents(const PassOptions& options, const grid::Levels& levels, std::size_t leaf,
                                             const particles::Particles& particles);

/// The same for one stray.
std::vector<AffineChunk> affine_of_stray(const PassOptions& options, const grid::Levels& levels, const Strays& strays,
                                         std::size_t stray, const particles::Particles& particles);

[[gnu::always_inline]] inline void store_affine(const AffineChunk& chunk, particles::Particles& particles)
{
    for (std::size_t n = 0; n < 9; ++n) {
        particles::Column& entry = particles.affine[n];
        store(core::select(chunk.here, chunk.affine.m[n], load(entry, chunk.begin, chunk.count)), entry, chunk.begin,
              chunk.count);
    }
}
void store_affine(const std::vector<AffineChunk>& chunks, particles::Particles& particles);

/// Sum m w C of the residents of a leaf's hanging cells for the corners of their cell; replaces the sums. Nothing
/// unless APIC.
/// @param levels  writes hanging.affine of the leaf's cells
void scatter_affine(const PassOptions& options, const particles::Particles& particles, std::size_t leaf,
                    grid::Levels& levels);

/// Add the strays, each to the sums of the cell it is in, in particle order.
void scatter_stray_affine(const PassOptions& options, const Strays& strays, const particles::Particles& particles,
                          grid::Levels& levels);
} // namespace transfer
