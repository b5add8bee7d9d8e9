/// Faces of the bodies' surfaces that surface loads push on.
///
/// Particles are sub-cubes of a lattice at time 0, each with the share chi of its cube that is metal. Between
/// neighbours the share jumps, and (chi_p - chi_n) s^2 is the area of surface between them as seen along that axis:
/// sums over a patch are its projected areas, whatever its shape (exact for planes, and for curved patches as exact as
/// the shares are).
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

#include <cstdint>
#include <vector>

namespace solver
{
/// Force on one face, at full ramp.
struct FaceForce
{
    std::uint32_t particle = 0; // present place
    std::int32_t load = 0;      // index into Problem::surface_loads
    Vec3 offset = Vec3::Zero(); // mm, from the particle to the middle of its face, at rest
    Vec3 force = Vec3::Zero();  // N
};

struct SurfaceForces
{
    std::vector<FaceForce> face;      // sorted by particle
    std::vector<std::uint32_t> start; // [particle + 1] faces of a particle; empty: no surface loads
    std::vector<Vec3> total;          // [load] N, modelled part, at full ramp
    std::vector<Real> area;           // [load] mm^2
};

/// @error core::InputError if a load finds no face
SurfaceForces find_surface_forces(const Problem& problem, const particles::Particles& particles,
                                  const Prepared& prepared);
} // namespace solver
