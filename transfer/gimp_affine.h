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

#include "transfer/gimp_part.h"
#include "transfer/hanging_cell.h"

#include <algorithm>

namespace transfer
{
/// Sums of D, diagonal [mm^2], and of the slaves' part of B.
struct BoxMoments
{
    std::array<Real, 3> inertia{};
    core::Mat<Real> hanging{}; // mm^2/ms
};

/// The hanging corners of the cell a part lies in: one cell of the range, or none.
inline HangingRange hanging_corners(const BoxPart& part, const grid::Levels& levels)
{
    const auto leaf = static_cast<std::size_t>(part.leaf);
    return narrowed(hanging_cells(levels, leaf), leaf * grid::leaf_cells + static_cast<std::size_t>(part.cell));
}

inline Real corner_weight(const BoxPart& part, std::size_t corner)
{
    return part.axis[0].weight[corner >> 2] * part.axis[1].weight[corner >> 1 & 1] * part.axis[2].weight[corner & 1];
}

/// Add one part of a cut box.
inline void add_moments(const BoxPart& part, const grid::Levels& levels, BoxMoments& moments)
{
    Real total[3], square[3];
    for (int a = 0; a < 3; ++a) {
        const BoxAxis& axis = part.axis[a];
        total[a] = axis.weight[0] + axis.weight[1];
        square[a] = axis.weight[0] * axis.arm[0] * axis.arm[0] + axis.weight[1] * axis.arm[1] * axis.arm[1];
    }
    for (std::size_t a = 0; a < 3; ++a) moments.inertia[a] += square[a] * total[(a + 1) % 3] * total[(a + 2) % 3];
    const HangingRange range = hanging_corners(part, levels);
    if (range.begin == range.end) return;
    const grid::LevelInterface& face = *range.face;
    const Real spacing = levels.spacing(levels.leaves[static_cast<std::size_t>(part.leaf)].level);
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::int32_t slave = face.hanging.slave[range.begin][corner];
        if (slave < 0) continue;
        const Real w = corner_weight(part, corner);
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

/// Add m w C of a particle to the hanging corners of the part's cell.
inline void scatter_affine_part(const BoxPart& part, const BoxGift& gift, grid::Levels& levels)
{
    const HangingRange range = hanging_corners(part, levels);
    if (range.begin == range.end) return;
    const auto level = static_cast<std::size_t>(levels.leaves[static_cast<std::size_t>(part.leaf)].level);
    grid::CornerAffine& to = levels.interface[level - 1].hanging.affine[range.begin];
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t corner = 0; corner < 8; ++corner)
                to.entry[3 * a + b][corner] +=
                    corner_weight(part, corner) * part.axis[a].sign * part.axis[b].sign * gift.slope[b][1 + a];
}

/// Zero what the hanging corners of a leaf have collected.
inline void clear_affine(std::size_t leaf, grid::Levels& levels)
{
    const HangingRange range = hanging_cells(levels, leaf);
    if (range.begin == range.end) return;
    auto& affine = levels.interface[static_cast<std::size_t>(levels.leaves[leaf].level - 1)].hanging.affine;
    std::fill(affine.begin() + static_cast<std::ptrdiff_t>(range.begin),
              affine.begin() + static_cast<std::ptrdiff_t>(range.end), grid::CornerAffine{});
}
} // namespace transfer
