/// Output columns computed from the particles: what a field name of io/particle_fields.h means in numbers.
#pragma once

#include "grid/levels.h"
#include "io/particle_fields.h"
#include "particles/particles.h"

#include <vector>

namespace io
{
/// Values of one field, row by row: [p][components], in the unit of the table.
std::vector<Real> particle_column(const ParticleField& field, const particles::Particles& particles,
                                  const grid::Levels& levels);

/// Current positions, row by row: [p][3] mm.
std::vector<Real> particle_points(const particles::Particles& particles);

/// Current volume of every particle [mm^3]: J V0 with J = det F (total) or the volume ratio (updated).
std::vector<Real> particle_volumes(const particles::Particles& particles);

/// Edge of the undeformed cube every particle stands for [mm]: h of its size level over the cube root of the particles
/// per cell. Particles cut by the surface of the body count as whole.
std::vector<Real> particle_sides(const particles::Particles& particles, const grid::Levels& levels,
                                 int particles_per_cell);

/// Damage of every particle [1]: 0 where no crack has begun.
std::vector<Real> particle_damage(const particles::Particles& particles);
} // namespace io
