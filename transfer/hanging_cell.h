/// The affine matrix of APIC in a cell with hanging corners, formed with the positions of the masters.
///
/// On the basis of the free nodes a (methods.md A.3.5), with slaves i and their masters a,
///
///     C = B D^{-1},   B = sum_i w_i (v_i (x) (x_i - x_p) + K_i),   D = sum_i w_i ((x_i - x_p) (x) (x_i - x_p) + X_i)
///     K_i = sum_a P_ia v_a (x) (x_a - x_i),   X_i = sum_a P_ia (x_a - x_i) (x) (x_a - x_i)
///
/// X_i is h^2 on the diagonal for each odd index of the slave, so D is diagonal. Along an axis one side of the cell has
/// odd indices, the other even ones; b and d, the entries of B and D for the axis, share the factor w_odd, the weight
/// of the odd side. What is left is a mean of velocity gradients,
///
///     C_axis = (w_even g + sum_j w_j k_j) / (w_even + sum_j w_j),
///
/// g: that of the cell, weight of the even side; k_j: between the masters of a hanging corner j, weight across the
/// axis. So C stays finite where D vanishes, is bounded by the gradients around, and is g in cells without hanging
/// corners. Only where all weights vanish (a particle exactly on the odd side, away from its hanging corners) the limit
/// depends on the direction: there C is g, and as D is zero on that axis, no choice changes any momentum.
#pragma once

#include "transfer/chunk.h"

#include <limits>

namespace transfer
{
/// Hanging cells of one leaf: [begin, end) of face->hanging; none if `face` is null.
struct HangingRange
{
    const grid::LevelInterface* face = nullptr;
    std::size_t begin = 0, end = 0;
};

HangingRange hanging_cells(const grid::Levels& levels, std::size_t leaf);

/// The part of a range that is the cell `slot` (leaf * 512 + cell): one cell, or empty.
HangingRange narrowed(const HangingRange& range, std::size_t slot);

/// Slopes of the velocity between the masters of one cell's hanging corners.
struct HangingSlopes
{
    std::array<int, 3> odd{};                                  // 1: the upper side of the axis has the odd index
    std::array<bool, 3> any{};                                 // some corner hangs along the axis
    std::array<std::array<bool, 4>, 3> hangs{};                // [axis][2 b + c], b and c the next axes in turn
    std::array<std::array<std::array<Real, 3>, 4>, 3> slope{}; // mm/ms per spacing, [axis][2 b + c][component]
};

/// @param c  number of the cell in `face.hanging`
HangingSlopes read_slopes(const grid::Levels& levels, const grid::LevelInterface& face, std::size_t c);

/// C from the velocity gradient of the cell.
[[gnu::always_inline]] inline core::Mat<Lanes> through_masters(const HangingSlopes& masters,
                                                               const core::Mat<Lanes>& gradient,
                                                               const LocalPosition<Lanes>& at, Real per_spacing)
{
    const Lanes zero(Real(0)), one(Real(1));
    const Lanes local[3] = {at.xi, at.eta, at.zeta};
    Lanes weight[3][2];
    for (int a = 0; a < 3; ++a) {
        // Rounding may leave a position just outside; all weights must be of one sign for the mean to be bounded.
        weight[a][1] = core::min(core::max(local[a], zero), one);
        weight[a][0] = one - weight[a][1];
    }
    core::Mat<Lanes> affine = gradient;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        if (!masters.any[axis]) continue;
        Lanes share = zero;
        Lanes slope[3] = {zero, zero, zero};
        for (std::size_t j = 0; j < 4; ++j) {
            if (!masters.hangs[axis][j]) continue;
            const Lanes w = weight[(a + 1) % 3][j >> 1] * weight[(a + 2) % 3][j & 1];
            share += w;
            for (std::size_t d = 0; d < 3; ++d) slope[d] += w * Lanes(masters.slope[axis][j][d]);
        }
        const Lanes all = weight[a][1 - masters.odd[axis]] + share;
        const Lanes per_all = one / core::max(all, Lanes(std::numeric_limits<Real>::min()));
        for (int d = 0; d < 3; ++d) affine(d, a) += per_all * (Lanes(per_spacing) * slope[d] - share * gradient(d, a));
    }
    return affine;
}
} // namespace transfer
