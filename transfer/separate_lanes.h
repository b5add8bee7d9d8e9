/// The cold side of the material update: particles with decohesion state, and particles that may get one.
#pragma once

#include "transfer/chunk.h"
#include "transfer/onset.h"
#include "transfer/passes.h"

#include <vector>

namespace transfer
{
/// One chunk at the end of its stress update, for the lanes that follow another law.
struct SeparatingChunk
{
    const PassOptions& options;
    const LawTable& laws;
    Real per_spacing; // 1/mm, of the cell
    std::size_t begin;
    int count;
    LaneMask here;
    core::Sym<Lanes> strain; // 1, increment
    core::Vec<Lanes> spin;   // 1
    core::Sym<Lanes> stress; // MPa, before the step
    Lanes eq_plastic_strain; // 1, before the step
    Lanes volume;            // mm^3, without regard to openings
};

/// Replace stress, plastic strain and plastic work of every lane with a crack by those of separate_particle.
/// @param particles        writes stress, eq_plastic_strain, cracks
/// @param plastic_work     mJ, lanes with a crack are replaced
/// @return decohesion work of the chunk [mJ]
Real separate_lanes(const SeparatingChunk& chunk, particles::Particles& particles, Lanes& plastic_work);

/// Test the intact particles [begin, end) of a cell for the onset of decohesion; append those that start. Materials
/// with a nonlocal radius are left to transfer/nonlocal_onset.h.
/// @param spacing    mm, of the cell
/// @param stresses   MPa, of each particle, [end - begin]
/// @param gradients  1, L dt of each particle, [end - begin]
/// @param here       [end - begin], whether this visit serves the particle: others count where they are
void start_cracks(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t begin, std::size_t end, Real spacing, const core::Sym<Real>* stresses,
                  const core::Mat<Real>* gradients, const bool* here, std::vector<Onset>& onset);
} // namespace transfer
