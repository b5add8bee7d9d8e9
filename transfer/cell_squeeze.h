/// How far deformation shortens the time step that a cell allows (methods.md A.6).
#pragma once

#include "core/real.h"
#include "core/simd.h"
#include "core/tensor.h"

#include <limits>

namespace transfer
{
/// Share of (deformed cell width / wave speed) that the step may not exceed. A cell at a cut edge may hold one particle
/// alone, a quarter of a cell from its nodes: omega^2 = 3 K / (rho h^2) (1/xi + 1/(1 - xi)) = 9.9 c_d^2 / h^2 at xi =
/// 1/4 and nu = 0.3, so dt < 2 / omega = 0.635 h / c_d; a full cell allows 0.734. Seen: 0.7 is unstable there.
inline constexpr Real deformed_step_share = 0.63;

/// The same for full cells, which share their nodes with others (methods.md A.6: 0.99 on assembled meshes): beyond it
/// a squeezed cell is unstable for certain.
inline constexpr Real unstable_step_share = 1;

namespace detail
{
/// max over axes of |J F^{-T} e_a|^2.
template <class T>
T largest_face(const core::Mat<T>& f)
{
    const core::Mat<T> cof = core::cofactor(f);
    T largest(Real(0));
    for (int a = 0; a < 3; ++a)
        largest = core::max(largest, cof(0, a) * cof(0, a) + cof(1, a) * cof(1, a) + cof(2, a) * cof(2, a));
    return largest;
}
} // namespace detail

/// Width of a cell over its smallest width after the deformation F: q = max over axes of |F^{-T} e_a|, infinite if
/// J <= 0. T is a number or a core::Pack.
template <class T>
T cell_squeeze(const core::Mat<T>& f)
{
    const T jacobian = core::determinant(f);
    const T infinite(std::numeric_limits<Real>::infinity());
    return core::select(jacobian > T(Real(0)), core::sqrt(detail::largest_face(f)) / jacobian, infinite);
}

/// Stiffness over mass of a cell after the deformation F, over that at rest: q^2 min(1, J), infinite if J <= 0. What
/// shrinks keeps its mass and has J of its volume to be stiff with; volume that grew is not counted, as it may be the
/// opening of a crack.
template <class T>
T cell_stiffening(const core::Mat<T>& f)
{
    const T jacobian = core::determinant(f);
    const T infinite(std::numeric_limits<Real>::infinity());
    return core::select(jacobian > T(Real(0)), detail::largest_face(f) / (jacobian * core::max(jacobian, T(Real(1)))),
                        infinite);
}
} // namespace transfer
