/// What a case will cost, from counting its particles without keeping them.
#pragma once

#include "solver/problem.h"

#include <cstdint>
#include <string>
#include <vector>

namespace app
{
/// Speed per thread assumed where nothing was measured [particle-steps/s]; `cleave bench` measures it on the machine at
/// hand.
Real assumed_steps_per_s(const solver::Numerics& numerics);

inline constexpr Real program_bytes = 50e6;     // byte, with its libraries
inline constexpr Real bytes_per_particle = 360; // byte, columns and sorting buffers, at the beginning and for output
inline constexpr Real bytes_per_leaf = 120e3;   // byte, tile of 9^3 nodes with sums and motion, and tables

/// What a grid holds: hangs on bodies, zones and [grid] alone.
struct ParticleCount
{
    std::vector<std::uint64_t> particles; // per level
    std::uint64_t leaves = 0;             // 1, 8^3 blocks of cells on all levels
    bool estimated = false;               // from volumes

    std::uint64_t total_particles() const;
};

struct Forecast : ParticleCount
{
    Real dt = 0;              // ms, of the finest level, before deformation shortens it
    Real end_time = 0;        // ms, by end.time or end.cod at full speed; infinite: not known
    Real steps = 0;           // 1, of the coarsest level
    Real particle_steps = 0;  // 1, with sub-cycling those of finer levels several times a step
    Real memory = 0;          // byte
    Real particle_frames = 0; // 1
    Real particle_bytes = 0;  // byte, all frames
    Real grid_frames = 0;     // 1
    Real grid_bytes = 0;      // byte, all frames
    Real vdb_frames = 0;      // 1
    Real vdb_bytes = 0;       // byte, all frames
    Real kinetic_share = 0;   // 1, kinetic over elastic energy of a body that yields everywhere
};

/// Those sections of a resolved case on which hangs what its grid holds: equal for cases whose particles need counting
/// but once.
std::string grid_sections(const std::string& resolved);

/// From the volumes of bodies and zones: at once, whatever their number.
ParticleCount estimate_particles(const solver::Problem& problem);

/// Count particles level by level as a run would seed them, slab by slab so that memory stays small: seconds for
/// millions. More than `countable` are estimated.
ParticleCount count_particles(const solver::Problem& problem);

inline constexpr Real countable = 3e7; // particles, half a minute

/// Memory that a run takes [byte].
Real memory_of(const ParticleCount& counted);

Forecast forecast(const solver::Problem& problem);

/// The same where the particles of the grid are counted already.
Forecast forecast(const solver::Problem& problem, const ParticleCount& counted);

/// Levels in the plane through the middle of the bodies, across their thinnest direction: one character per place, '.'
/// void, '0' the coarsest level; at most `columns` wide.
std::string level_map(const solver::Problem& problem, int columns);
} // namespace app
