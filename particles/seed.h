/// Fill a cell with particles of a body.
#pragma once

#include "geometry/shape.h"
#include "particles/particles.h"

namespace particles
{
/// How a sub-cell cut by the surface counts.
enum class EdgeTreatment
{
    fraction,  // volume scaled by the part of the sub-cell inside the body
    staircase, // in or out by its centre
    distance,  // as fraction, but from distances to the surface
};

/// What every new particle of a body shares.
struct SeedTraits
{
    Real density = 0;             // g/mm^3
    Vec3 velocity = Vec3::Zero(); // mm/ms
    std::uint8_t material = 0;
    EdgeTreatment edge = EdgeTreatment::fraction;
    std::uint8_t body = 0;
};

/// Sub-cells with a smaller part inside the body get no particle: their nodes would add noise, not stiffness.
inline constexpr Real smallest_fraction = 0.02;

/// Append `per_axis`^3 particles, one at the centre of each sub-cell that lies in `shape`; x outermost, z innermost.
///
/// @param lower, spacing  mm, lower corner and edge of the cell
/// @param level           stored as target and size level
/// @param particles       position, rest position, velocity, stress 0, rest volume, mass = density * volume are
///                        appended; ids continue from the present size. Columns that only one formulation needs stay
///                        as they are (see solver/initialise.cpp).
/// @return number of particles added
int seed_cell(const geometry::Shape& shape, const SeedTraits& traits, const Vec3& lower, Real spacing, int per_axis,
              int level, Particles& particles);

/// Part of the cube [centre - half, centre + half]^3 inside the shape, from 4^3 sample points when the surface may cut
/// it; exact 0 or 1 when it cannot.
///
/// Points count fully or not at all: where the surface is nearly parallel to a face of the cube all of them may lie on
/// one side, an error of up to 1/8. With EdgeTreatment::distance each counts with clamp(1/2 - d / w), d its signed
/// distance and w the spacing of the points: exact for planes along the axes, of second order else.
Real inside_fraction(const geometry::Shape& shape, const Vec3& centre, Real half,
                     EdgeTreatment edge = EdgeTreatment::fraction);
} // namespace particles
