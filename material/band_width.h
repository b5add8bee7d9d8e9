/// Width of a band of cells across a plane, in cells: sum |n_i|, so that L_e = c_b h sum |n_i| (methods.md D.5).
#pragma once

#include "core/tensor.h"

#include <cmath>

namespace material
{
/// 1, between 1 (plane along the cells) and sqrt 3.
/// @pre  unit normal
inline double band_width(const core::Vec<double>& normal)
{
    return std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
}
} // namespace material
