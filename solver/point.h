/// A single material point without a grid: strain and rotation in, stress and state out, by the laws of material/.
///
/// The order within a step is that of the transfer: rotate the stress, elastic trial, return to the yield surface,
/// onset on the returned stress (the step of the onset changes no stress); once there is a crack, material::separate.
/// The cell mean that a smoothed onset is tested on, and dilatation = "cell", are the point's own values here.
#pragma once

#include "core/crack.h"
#include "core/tensor.h"
#include "material/elastic.h"
#include "material/separation.h"
#include "material/von_mises.h"

#include <cstdint>
#include <optional>

namespace solver
{
/// Constants of the laws of one material, computed once.
struct PointLaw
{
    material::Material material;
    material::LameConstants<Real> lame{};
    std::optional<material::PlasticConstants<Real>> plastic; // empty: elastic
    std::optional<material::SeparationLaw> separation;       // empty: never breaks
    Real spacing = 0;                                        // mm, cell size h of the effective length
};

PointLaw point_law(const material::Material& material, Real spacing);

/// One step as the laws see it; components in fixed axes.
struct PointStep
{
    core::Sym<Real> strain;   // 1, integral of the rate of deformation over the step
    core::Vec<Real> rotation; // 1 (rad), integral of the spin
    Real dt = 0;              // ms
};

struct PointState
{
    std::int64_t step = 0;
    Real time = 0;                    // ms
    core::Sym<Real> strain{};         // 1, sum of the steps' strains
    core::Sym<Real> stress{};         // MPa
    Real eq_plastic_strain = 0;       // 1
    Real plastic_work = 0;            // mJ/mm^3
    Real decohesion_work = 0;         // mJ/mm^3, of opening, slip and friction
    std::optional<core::Crack> crack; // empty: intact
    std::int64_t onset_step = 0;      // of the crack
    Real acoustic_ratio = 1;          // 1, material::bifurcation of the step; 1: elastic, or there is a crack
};

/// The state one step later. @cost about 1 us, no allocation
PointState advance(const PointLaw& law, const PointState& before, const PointStep& step);
} // namespace solver
