/// The cold side of the material update: particles with decohesion state, and particles that may get one.
#pragma once

#include "transfer/chunk.h"
#include "transfer/passes.h"

#include <vector>

namespace transfer
{
/// A particle that begins to separate in this step; it softens from the next one on (methods.md D.11, 14).
struct Onset
{
    std::uint32_t particle = 0;
    core::Crack crack;
};

/// One chunk at the end of its stress update, for the lanes that follow another law.
struct SeparationInput
{
    const PassOptions& options;
    const LawTable& laws;
    Real per_spacing; // 1/mm, of the cell
    std::size_t begin;
    int count;
    LaneMask here;
    core::Sym<Lanes> strain;   // 1, increment
    core::Mat<Lanes> rotation; // 1
    core::Sym<Lanes> stress;   // MPa, before the step
    Lanes eq_plastic_strain;   // 1, before the step
    Lanes volume;              // mm^3, without regard to openings
};

/// Replace stress, plastic strain and plastic work of every lane with a crack by those of material::separate.
/// A separated particle whose cell is turned inside out, or squeezed beyond what the time step can follow, carries no
/// stress and dissipates nothing (docs/decisions/007).
/// @param particles        writes stress, eq_plastic_strain, cracks
/// @param plastic_work     mJ, lanes with a crack are replaced
/// @return decohesion work of the chunk [mJ]
Real separate_lanes(const SeparationInput& input, particles::Particles& particles, Lanes& plastic_work);

/// Test the intact particles [begin, end) of a cell for the onset of decohesion; append those that start.
/// @param spacing    mm, of the cell
/// @param gradients  1, L dt of each particle, [end - begin]
void start_cracks(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t begin, std::size_t end, Real spacing, const core::Mat<Real>* gradients,
                  std::vector<Onset>& onset);
} // namespace transfer
