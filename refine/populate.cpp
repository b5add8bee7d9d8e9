#include "refine/populate.h"

#include <cmath>

namespace refine
{
namespace
{
void fill(const geometry::Shape& shape, const particles::SeedTraits& traits, const Lattice& lattice,
          const grid::Refinement& refinement, int per_axis, int level, const Index3& cell,
          particles::Particles& particles)
{
    const Real spacing = lattice.spacing0 / static_cast<Real>(1 << level);
    const Vec3 lower = lattice.origin + spacing * cell.cast<Real>();
    if (shape.distance(lower + Vec3::Constant(spacing / 2)) > spacing * std::sqrt(Real(3)) / 2) return;
    if (level + 1 < lattice.levels && refinement.subdivided(level, cell)) {
        for (int c = 0; c < 8; ++c)
            fill(shape, traits, lattice, refinement, per_axis, level + 1, 2 * cell + Index3(c >> 2, c >> 1 & 1, c & 1),
                 particles);
        return;
    }
    particles::seed_cell(shape, traits, lower, spacing, per_axis, level, particles);
}
} // namespace

void populate(const geometry::Shape& shape, const particles::SeedTraits& traits, const Lattice& lattice,
              const grid::Refinement& refinement, int per_axis, particles::Particles& particles)
{
    const geometry::Bounds bounds = shape.bounds();
    const Index3 lower = grid::cell_at((bounds.lower - lattice.origin) / lattice.spacing0, 0);
    const Index3 upper = grid::cell_at((bounds.upper - lattice.origin) / lattice.spacing0, 0);
    for (int i = lower[0]; i <= upper[0]; ++i)
        for (int j = lower[1]; j <= upper[1]; ++j)
            for (int k = lower[2]; k <= upper[2]; ++k)
                fill(shape, traits, lattice, refinement, per_axis, 0, Index3(i, j, k), particles);
}
} // namespace refine
