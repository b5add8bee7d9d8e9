/// Boxes read velocities off the grid, one by one; lanes of particles are filled from what they read.
#pragma once

#include "transfer/chunk.h"
#include "transfer/gimp_affine.h"

namespace transfer
{
/// What a chunk of boxes has read, one array entry per particle.
struct BoxChunk
{
    static constexpr int lanes = 8;
    alignas(64) Real value[8][lanes];    // lanes of grid::NodeMotion
    alignas(64) Real along[3][8][lanes]; // slopes (and moments) of these, see BoxSample
    alignas(64) Real affine[9][lanes];   // 1/ms, C of APIC
};

/// What the caller wants besides the values.
enum class BoxWant
{
    slopes, // of velocity and change
    affine, // and slopes of the velocity
};

template <BoxWant Want>
void gather_boxes(const BoxCutter& cutter, const particles::Particles& particles, std::size_t begin, int count,
                  std::size_t home, BoxParts& parts, BoxChunk& chunk)
{
    static_assert(BoxChunk::lanes >= Lanes::lanes);
    NodeLine line[4][BoxChunk::lanes];
    for (int i = 0; i < count; ++i) {
        cutter.cut(particles, begin + static_cast<std::size_t>(i), home, parts);
        BoxSample sample;
        clear(sample);
        BoxMoments moments;
        for (const BoxPart& part : parts.part) {
            const auto leaf = static_cast<std::size_t>(part.leaf);
            gather_part<Want == BoxWant::affine>(part, cutter.levels.motions(leaf), sample);
            if constexpr (Want == BoxWant::affine) add_moments(part, cutter.levels, cutter.hangs[leaf] != 0, moments);
        }
        line[0][i] = sample.value;
        for (int b = 0; b < 3; ++b) line[1 + b][i] = sample.along[b];
        if constexpr (Want == BoxWant::affine) {
            const core::Mat<Real> c = affine_of(sample, moments);
            for (std::size_t n = 0; n < 9; ++n) chunk.affine[n][i] = c.m[n];
        }
    }
    // Lanes without a particle are computed with, never stored.
    for (int i = count; i < BoxChunk::lanes; ++i) {
        for (auto& of_quantity : line) of_quantity[i] = NodeLine(Real(0));
        if constexpr (Want == BoxWant::affine)
            for (int n = 0; n < 9; ++n) chunk.affine[n][i] = 0;
    }
    for (auto& of_quantity : line) core::transpose(of_quantity);
    for (int q = 0; q < 8; ++q) {
        line[0][q].store(chunk.value[q]);
        for (int b = 0; b < 3; ++b) line[1 + b][q].store(chunk.along[b][q]);
    }
}

/// Gradient of the three quantities from `column` on.
[[gnu::always_inline]] inline core::Mat<Lanes> gradient_lanes(const BoxChunk& chunk, int column)
{
    core::Mat<Lanes> g;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) g(a, b) = Lanes::load(chunk.along[b][column + a]);
    return g;
}

[[gnu::always_inline]] inline core::Mat<Lanes> affine_lanes(const BoxChunk& chunk)
{
    core::Mat<Lanes> c;
    for (std::size_t n = 0; n < 9; ++n) c.m[n] = Lanes::load(chunk.affine[n]);
    return c;
}
} // namespace transfer
