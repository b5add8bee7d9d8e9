/// The affine matrix of APIC on boxes.
///
///     C = B D^{-1},   B = sum_a Phi_a v_a (x) (x_a - x_p),   D = sum_a Phi_a (x_a - x_p) (x) (x_a - x_p)
///
/// over the free nodes a (methods.md A.3.5). On one level D_xx = mean of xi (1 - xi) h^2 over the box + l^2 / 3: never
/// small, so C is formed by dividing. D is diagonal also where levels meet: cutting a box by planes into boxes keeps
/// its mixed moments, which are zero. Slaves that hang between their masters add
///
///     B += w_i K_i,  K_i = sum_a P_ia v_a (x) (x_a - x_i),      D += w_i X_i,  X_i = sum_a P_ia (x_a - x_i)^2
///
/// and on the way to the grid collect T_i = sum_p m_p w_i C_p (grid/hanging.h).
#pragma once

#include "transfer/gimp_lines.h"
#include "transfer/hanging_cell.h"

namespace transfer
{
/// Sums of D, diagonal [mm^2], and of the slaves' part of B.
struct BoxMoments
{
    std::array<Real, 3> inertia{};
    core::Mat<Real> hanging{}; // mm^2/ms
};

/// Add one part.
/// @param hangs  the leaf has hanging cells: the part lies in one cell
inline void add_moments(const BoxPart& part, const grid::Levels& levels, bool hangs, BoxMoments& moments)
{
    Real total[3] = {0, 0, 0}, square[3] = {0, 0, 0};
    for (int a = 0; a < 3; ++a)
        for (int n = 0; n < part.axis[a].count; ++n) {
            const BoxAxis& axis = part.axis[a];
            total[a] += axis.weight[n];
            square[a] += axis.weight[n] * axis.arm[n] * axis.arm[n];
        }
    for (std::size_t a = 0; a < 3; ++a) moments.inertia[a] += square[a] * total[(a + 1) % 3] * total[(a + 2) % 3];
    if (!hangs) return;
    const auto leaf = static_cast<std::size_t>(part.leaf);
    const HangingRange range =
        narrowed(hanging_cells(levels, leaf), leaf * grid::leaf_cells + static_cast<std::size_t>(part.cell));
    if (range.begin == range.end) return;
    const grid::LevelInterface& face = *range.face;
    const Real spacing = levels.spacing(levels.leaves[leaf].level);
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::int32_t slave = face.hanging.slave[range.begin][corner];
        if (slave < 0) continue;
        const Real w =
            part.axis[0].weight[corner >> 2] * part.axis[1].weight[corner >> 1 & 1] * part.axis[2].weight[corner & 1];
        const auto s = static_cast<std::size_t>(slave);
        for (auto e = static_cast<std::size_t>(face.row_start[s]); e < static_cast<std::size_t>(face.row_start[s + 1]);
             ++e) {
            const grid::NodeAddress& at = face.row_master[e];
            const grid::NodeMotion& master = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
            for (std::size_t b = 0; b < 3; ++b) {
                const Real offset = face.row_offset[e][b] * spacing;
                const Real share = w * face.row_weight[e] * offset;
                moments.inertia[b] += share * offset;
                for (std::size_t a = 0; a < 3; ++a)
                    moments.hanging.m[3 * a + b] += share * part.axis[a].sign * part.axis[b].sign * master.velocity[a];
            }
        }
    }
}

/// C of a whole box, from a sample with moments.
inline core::Mat<Real> affine_of(const BoxSample& sample, const BoxMoments& moments)
{
    core::Mat<Real> c;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            c(a, b) = (sample.along[b][4 + a] + moments.hanging(a, b)) / moments.inertia[static_cast<std::size_t>(b)];
    return c;
}

/// Add m w C of a particle to the hanging corners of the part's cell.
/// @param affine  mC [g/ms], row by row
inline void scatter_affine_part(const BoxPart& part, const std::array<Real, 9>& affine, grid::Levels& levels)
{
    const auto leaf = static_cast<std::size_t>(part.leaf);
    const HangingRange range =
        narrowed(hanging_cells(levels, leaf), leaf * grid::leaf_cells + static_cast<std::size_t>(part.cell));
    if (range.begin == range.end) return;
    grid::CornerAffine& to =
        levels.interface[static_cast<std::size_t>(levels.leaves[leaf].level - 1)].hanging.affine[range.begin];
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t corner = 0; corner < 8; ++corner)
                to.entry[3 * a + b][corner] += part.axis[0].weight[corner >> 2] * part.axis[1].weight[corner >> 1 & 1] *
                                               part.axis[2].weight[corner & 1] * part.axis[a].sign * part.axis[b].sign *
                                               affine[3 * a + b];
}
} // namespace transfer
