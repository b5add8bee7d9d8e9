/// How far deformation shortens the time step that a cell allows (methods.md A.6).
#pragma once

#include "core/real.h"
#include "core/tensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace transfer
{
/// Share of (deformed cell width / wave speed) that the step may not exceed. A cell at a cut edge may hold one particle
/// alone, a quarter of a cell from its nodes: omega^2 = 3 K / (rho h^2) (1/xi + 1/(1 - xi)) = 9.9 c_d^2 / h^2 at xi =
/// 1/4 and nu = 0.3, so dt < 2 / omega = 0.635 h / c_d; a full cell allows 0.734. Seen: 0.7 is unstable there.
inline constexpr Real deformed_step_share = 0.63;

/// The same for cells that share their nodes with full neighbours (methods.md A.6: 0.99 on assembled meshes): beyond it
/// a squeezed cell is unstable for certain.
inline constexpr Real unstable_step_share = 1;

/// Width of a cell over its smallest width after the deformation F: max over axes of |F^{-T} e_a|, infinite if J <= 0.
inline Real cell_squeeze(const core::Mat<Real>& f)
{
    const Real jacobian = core::determinant(f);
    if (!(jacobian > 0)) return std::numeric_limits<Real>::infinity();
    const core::Mat<Real> cof = core::cofactor(f);
    Real longest = 0;
    for (int a = 0; a < 3; ++a)
        longest = std::max(longest, cof(0, a) * cof(0, a) + cof(1, a) * cof(1, a) + cof(2, a) * cof(2, a));
    return std::sqrt(longest) / jacobian;
}
} // namespace transfer
