/// What both scatters of a box share: mass, momentum and force at the end of a step, momentum alone in the middle.
#pragma once

#include "transfer/chunk.h"
#include "transfer/gimp_affine.h"

#include <algorithm>

namespace transfer
{
/// Lines of up to `Lanes::lanes` particles. First by quantity, then `turn` makes them the lines of each particle.
struct BoxStage
{
    alignas(64) Real row[4][8][8] = {}; // base and three slopes; [quantity][particle]
    NodeLine line[4][8];

    void turn()
    {
        for (int n = 0; n < 4; ++n) {
            for (int q = 0; q < 8; ++q) line[n][q] = NodeLine::load(row[n][q]);
            core::transpose(line[n]);
        }
    }
    BoxLines of(int i) const { return {line[0][i], {line[1][i], line[2][i], line[3][i]}}; }
};

/// Momentum and the affine part of it; mass and force are left zero.
template <Transfer T>
void stage_momentum(const particles::Particles& particles, std::size_t begin, int count, BoxStage& stage)
{
    const Lanes m = load(particles.mass, begin, count);
    for (std::size_t a = 0; a < 3; ++a) {
        (m * load(particles.velocity[a], begin, count)).store(stage.row[0][1 + a]);
        if constexpr (T == Transfer::apic)
            for (std::size_t b = 0; b < 3; ++b)
                (m * load(particles.affine[3 * a + b], begin, count)).store(stage.row[1 + b][1 + a]);
    }
}

/// Add the parts of a box that lie in `leaf`.
template <Transfer T>
void add_to_leaf(const BoxCutter& cutter, const BoxParts& parts, const BoxLines& lines, std::size_t leaf,
                 grid::Levels& levels)
{
    for (const BoxPart& part : parts.part) {
        if (part.leaf != static_cast<std::int32_t>(leaf)) continue;
        scatter_part(part, lines, levels.sums(leaf));
        if constexpr (T == Transfer::apic) {
            if (cutter.hangs[leaf] == 0) continue;
            std::array<Real, 9> affine;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) affine[static_cast<std::size_t>(3 * a + b)] = lines.slope[b][1 + a];
            scatter_affine_part(part, affine, levels);
        }
    }
}

/// Zero what the hanging corners of a leaf have collected.
template <Transfer T>
void clear_affine(std::size_t leaf, grid::Levels& levels)
{
    if constexpr (T == Transfer::apic) {
        const HangingRange range = hanging_cells(levels, leaf);
        if (range.begin == range.end) return;
        auto& affine = levels.interface[static_cast<std::size_t>(levels.leaves[leaf].level - 1)].hanging.affine;
        std::fill(affine.begin() + static_cast<std::ptrdiff_t>(range.begin),
                  affine.begin() + static_cast<std::ptrdiff_t>(range.end), grid::CornerAffine{});
    }
}
} // namespace transfer
