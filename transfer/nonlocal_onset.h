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
///
/// Stages: cells near a strength, the stress each is tested on (transfer/nonlocal_stress.h), cracks in order of excess
/// where no other forbids them (transfer/nonlocal_cracks.h).
#pragma once

#include "transfer/nonlocal_view.h"

namespace transfer
{
/// Steps between two tests: a wave cannot cross more than the radius in less, max(1, floor(R / (c_d dt))).
int nonlocal_interval(const LawTable& laws, Real dt);

/// Test all cells; cracks that start are recorded, their stress is not changed in this step.
///
/// @param levels     reads motion (halos filled), cell_start
/// @param lattice    reads stress and the cells near onset; writes cracked. Empty: other schemes
/// @param particles  reads stress (other schemes), positions; writes crack, cracks, lode_mean, lode_strain
/// @return number of particles that start
std::size_t start_nonlocal_cracks(const PassOptions& options, const LawTable& laws, const grid::Levels& levels,
                                  Lattice& lattice, particles::Particles& particles, NonlocalTable& table);
} // namespace transfer
