/// Separated particles of one material, eight at a time: the law of separate_particle for damage = 1, lanes =
/// particles.
///
/// Once a crack has run, its particles are a few per cent of all but each costs ten times as much as an intact one when
/// taken alone.
#pragma once

#include "transfer/separate_particle.h"

#include <array>

namespace transfer
{
struct SlideBatch
{
    static constexpr int size = 8;
    using Row = std::array<Real, size>;

    int count = 0;
    std::uint8_t material = 0;
    alignas(64) std::array<Row, 9> gradient;    // 1, L dt
    alignas(64) std::array<Row, 9> deformation; // 1, F at the end of the step
    alignas(64) std::array<Row, 6> stress;      // MPa, before and after
    alignas(64) Row eq_plastic_strain;          // 1, likewise
    alignas(64) Row volume;                     // mm^3, middle of the step, without regard to openings
    alignas(64) Row volume_ratio;               // 1, J there
    alignas(64) Row largest_share;              // 1, SeparationInput::largest_share
    std::array<core::Crack*, size> crack;
    alignas(64) Row plastic_work, decohesion_work; // mJ, of the step
};

/// Advance the first `count` particles of the batch and their cracks.
/// @pre  damage = 1
void slide_batch(const PassOptions& options, const LawTable& laws, Real per_spacing, SlideBatch& batch);
} // namespace transfer
