/// The velocity that FLIP gives a particle.
#pragma once

#include "transfer/chunk.h"

namespace transfer
{
/// v <- (1 - a) (v + dv) + a v_grid: the particle's own velocity and what the nodes have gained, blended with what the
/// nodes have (PIC, methods.md A.1).
/// @param pic_fraction   1, a
/// @param change         mm/ms, dv read off the grid
/// @param grid_velocity  mm/ms, read off the grid
[[gnu::always_inline]] inline Lanes flip_velocity(Real pic_fraction, Lanes old, Lanes change, Lanes grid_velocity)
{
    Lanes fresh = old + change;
    if (pic_fraction > 0) fresh += Lanes(pic_fraction) * (grid_velocity - fresh);
    return fresh;
}
} // namespace transfer
