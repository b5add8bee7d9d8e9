/// The law of one particle with decohesion state, as every kernel calls it for the particles it sets aside.
#pragma once

#include "core/tensor.h"
#include "material/separation.h"
#include "transfer/cell_squeeze.h"
#include "transfer/passes.h"

namespace transfer
{
/// A particle that is compressed further carries nothing any more (docs/decisions/007).
inline constexpr Real smallest_volume_ratio = 0.05;

/// Share of its cell's stable time that a step takes for a separated particle: c dt max |F^-T e_a| / h with c = c_d
/// sqrt(max(1, J s)), s the solid share. The cell keeps its mass while its stress acts on the volume it has grown to,
/// so one that is stretched along its crack grows stiff.
/// @param reach  1, c_d dt / h
/// @param metal  1, J s
template <class T>
T step_share(const T& reach, const T& metal, const core::Mat<T>& deformation)
{
    return reach * core::sqrt(core::max(metal, T(Real(1)))) * cell_squeeze(deformation);
}

/// What happens to the particle in the step.
struct SeparationInput
{
    material::StrainStep step;
    Real volume = 0;                              // mm^3, middle of the step, without regard to openings
    Real volume_ratio = 1;                        // 1, J there
    const core::Mat<Real>* deformation = nullptr; // 1, F at the end of the step; null in the updated formulation
    std::uint8_t material = 0;
    Real per_spacing = 1;                     // 1/mm, of its cell
    Real largest_share = unstable_step_share; // 1, of the squeezed cell's time, that the step may take
};

/// Without initial values: the kernels keep room for a block of them and fill what they need.
struct SeparationResult
{
    core::Sym<Real> stress; // MPa
    Real eq_plastic_strain; // 1
    Real plastic_work;      // mJ
    Real decohesion_work;   // mJ
};

/// Advance the crack by one step (material::separate). A separated particle whose cell is turned inside out, or
/// squeezed beyond what the time step can follow, carries no stress and dissipates nothing (docs/decisions/007).
SeparationResult separate_particle(const PassOptions& options, const LawTable& laws, const SeparationInput& input,
                                   core::Crack& crack);
} // namespace transfer
