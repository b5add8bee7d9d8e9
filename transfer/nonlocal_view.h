/// What the nonlocal onset (transfer/nonlocal_onset.h) reads, whichever scheme keeps it.
#pragma once

#include "material/material.h"
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

/// What the phase reads, bundled for its stages.
struct NonlocalView
{
    const PassOptions& options;
    const LawTable& laws;
    const grid::Levels& levels;
    const Lattice& lattice;
    const NonlocalTable& table;
};

/// NonlocalTable::place for all particles of the nodal scheme.
std::vector<std::uint32_t> lattice_places(const Lattice& lattice, std::size_t count);

/// Cauchy stress [MPa], from the blocks of the nodal scheme where that is in use.
core::Sym<Real> stress_of(const NonlocalView& view, const particles::Particles& particles, std::uint32_t p);

/// Equivalent plastic strain [1], likewise.
Real plastic_strain_of(const NonlocalView& view, const particles::Particles& particles, std::uint32_t p);

/// Mean stress [MPa] of the intact particles of a ball.
core::Sym<Real> mean_of(const NonlocalView& view, const particles::Particles& particles, const Ball& ball);

/// Law of a particle whose onset is tested here; null otherwise.
const material::Decohesion* nonlocal_law(const LawTable& laws, std::uint8_t material);
} // namespace transfer
