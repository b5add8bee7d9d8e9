/// Values of the kinds of measures at one time, each from no more than it needs.
#pragma once

#include "grid/levels.h"
#include "particles/particles.h"
#include "solver/problem.h"
#include "solver/quantity.h"
#include "solver/state.h"

namespace solver
{
/// Particles with every column, and what their sizes follow from.
struct ParticleView
{
    const particles::Particles& particles;
    const grid::Levels& levels;
    int per_axis;
};

/// Present over rest volume.
Real volume_ratio(const particles::Particles& particles, std::size_t p);
Real field_value(const FieldComponent& field, const particles::Particles& particles, std::size_t p);

// NaN where nothing is there to be measured.
Real value_of(const Probe& probe, const ParticleView& view);
Real value_of(const Difference& difference, const ParticleView& view);
Real value_of(const Extent& extent, const ParticleView& view);
Real value_of(const Momentum& momentum, const ParticleView& view);
Real value_of(const Volume& volume, const ParticleView& view);
Real value_of(const CrackQuantity& crack, const std::vector<material::Material>& materials,
              const particles::Particles& particles);
Real value_of(const Energy& energy, const Ledger& ledger);
/// @param clock  velocity belongs to time - dt / 2
Real value_of(const FieldError& error, const Problem& problem, const Clock& clock, const ParticleView& view);
} // namespace solver
