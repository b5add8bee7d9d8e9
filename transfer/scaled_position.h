/// Positions in cells of level 0, as grid::Refinement::locate takes them.
#pragma once

#include "core/error.h"
#include "grid/levels.h"
#include "particles/particles.h"

#include <cmath>
#include <string>

namespace transfer
{
/// @param at  position or rest position [mm]
inline Vec3 scaled_position(const grid::Levels& levels, const std::array<particles::Column, 3>& at, std::size_t p)
{
    // The product, not the quotient: the same rounding as in the kernels' test (transfer/chunk.h, inside).
    return (Vec3(at[0][p], at[1][p], at[2][p]) - levels.origin) * (Real(1) / levels.spacing0);
}

/// Whether indices of cells can name a place: not one that is no number, or flung away by an unstable computation.
/// @param cells  in cells of the finest level
inline bool is_place(const Vec3& cells)
{
    constexpr Real most = 1 << 30;
    return (cells.array().abs() < most).all();
}

/// scaled_position of a particle that is somewhere.
/// @error core::NumericalError that names it, if no cell can have it
inline Vec3 placed_position(const grid::Levels& levels, const std::array<particles::Column, 3>& at,
                            const particles::Particles& particles, std::size_t p)
{
    const Vec3 x = scaled_position(levels, at, p);
    if (!is_place(x * std::ldexp(Real(1), levels.count - 1)))
        throw core::NumericalError("particle " + std::to_string(particles.id[p]) +
                                   " has no finite position: the computation is unstable (smaller numerics.cfl?)");
    return x;
}
} // namespace transfer
