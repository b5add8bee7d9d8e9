/// Onset of decohesion on the stress averaged over a ball of fixed radius (docs/decisions/014): a phase of its own,
/// after the stress update, for materials with a nonlocal radius.
///
/// A strength tested on local stress is met the earlier the finer the cells; the mean over a length that does not
/// change with the cells converges. A cell starts as a whole, when
///   1. one of its own intact particles is near a strength (material::may_start), and
///   2. the mean over the ball about its centre meets the criterion; or, where the crack of a neighbouring cell leads
///      into it (the way there is less than 45 degrees off the crack's plane), the mean of the cell's own particles and
///      that of the metal which the crack would cut next, of the length of the ball's radius (docs/decisions/029); or
///      the cell's mean exceeds the criterion by a quarter (`overload`).
/// Only intact particles count in the means. Why the second way: around the end of a crack the ball is full of flanks
/// that carry nothing any more, the finer the cells the more of them, so its mean says little about the metal ahead;
/// bridges between pieces of a crack would never break. What a crack needs to go on is its energy, which the law asks
/// for. The cells that fulfil both start in order of how far they exceed it, and each forbids those beside it while it
/// softens: no plane closer than `crack_exclusion` to a parallel one (`excluded`). The mean field is smooth, so without
/// this rule a band as wide as the ball would separate instead of one layer of cells. A crack that has been unloaded
/// before it was through, because the load went elsewhere, relieves nobody and forbids nothing.
#pragma once

#include "transfer/ball.h"
#include "transfer/lattice.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace transfer
{
/// What does not change in the total formulation, made when first asked for: it depends on nothing but the particles at
/// rest, so a restart makes the same.
struct NonlocalTable
{
    std::unordered_map<std::uint64_t, Ball> ball; // by slot * 256 + material
    std::vector<std::uint32_t> place;             // [p] nodal scheme: (block * slots + slot) * lanes + lane
};

/// Ratio of a cell's own stress to the strength beyond which neither the ball nor a neighbour holds it back [1]. No
/// ball of metal in one piece leaves that much out: of the particles that start in the challenge specimen nine tenths
/// exceed the strength by less than 5 %. Scraps between pieces of a crack, or slivers at a rim, whose ball is empty of
/// stress, would be drawn out for ever.
inline constexpr Real overload = 1.25;

/// Share of what is left of its strength below which a crack does not soften [1]. Cracks in line carry the same
/// traction, so those that soften are near 1 and those that were passed by far below: in the challenge specimen nine
/// tenths are above 0.76, the others below 0.4.
inline constexpr Real idle_loading = 0.5;

/// Steps between two tests: a wave cannot cross more than the radius in less, max(1, floor(R / (c_d dt))).
int nonlocal_interval(const LawTable& laws, Real dt);

/// Test all cells; cracks that start are recorded, their stress is not changed in this step.
///
/// @param levels     reads motion (halos filled), cell_start
/// @param lattice    reads stress and the cells near onset; writes cracked. Empty: other schemes
/// @param particles  reads stress (other schemes), positions; writes crack, cracks
/// @return number of particles that start
std::size_t start_nonlocal_cracks(const PassOptions& options, const LawTable& laws, const grid::Levels& levels,
                                  Lattice& lattice, particles::Particles& particles, NonlocalTable& table);

/// Two planes side by side: distance along the normal of the crack beyond half a band but within `reach`, offset along
/// the plane less than a band, and normals less than 45 degrees apart.
/// @param offset  mm, from the crack to the new plane, at rest
/// @param normal  1, of the crack, at rest
/// @param fresh   1, normal of the new plane, at rest
/// @param band    mm, the larger L_e of the two
bool excluded(const Vec3& offset, const Vec3& normal, const Vec3& fresh, Real band, Real reach);
} // namespace transfer
