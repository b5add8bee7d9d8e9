/// Split particles that are too coarse for the cell they are in.
#pragma once

#include "particles/particles.h"

#include <span>

namespace particles
{
/// Replace particle p by eight children at x_p + (+-l/2) on every axis, one size level finer (methods.md A.8).
///
/// Children have m / 8, V0 / 8 and every other state of the parent. FLIP: v_c = v_p, which keeps mass, momentum,
/// angular momentum and kinetic energy. APIC: v_c = v_p + C_p (x_c - x_p), C_c = C_p. The first child keeps the
/// parent's id, the others get new ones. Cracked particles are left alone: their L_e must not jump (D.11, 20).
///
/// @param spacing0   mm, cell size of level 0; the parent's half width is spacing0 / 2^level / per_axis / 2
/// @return number of particles that were split
std::size_t split(std::span<const std::uint32_t> parents, Real spacing0, int per_axis, Particles& particles);
} // namespace particles
