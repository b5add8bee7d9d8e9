/// Principal values and directions of a symmetric tensor: cyclic Jacobi, scalar, cold path.
///
/// Jacobi keeps orthogonal directions to rounding for close and equal values, where the closed trigonometric form loses
/// half of its digits. Source: Golub & Van Loan, Matrix Computations, section 8.5.
#pragma once

#include "core/tensor.h"

#include <array>

namespace material
{
struct Principal
{
    std::array<double, 3> value;                // s_1 >= s_2 >= s_3, unit of the tensor
    std::array<core::Vec<double>, 3> direction; // 1, right-handed: n_3 = n_1 x n_2
};

/// Spectral decomposition. Signs are fixed: of n_1 and n_2 the component of largest magnitude is positive. For equal
/// values the directions are some orthonormal basis, always the same one for the same input bits.
/// @pre finite components
Principal principal(const core::Sym<double>& tensor);

/// The direction or its opposite, by the sign rule of `principal`.
core::Vec<double> with_fixed_sign(const core::Vec<double>& direction);
} // namespace material
