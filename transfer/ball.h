/// A ball about a cell's centre and the particles in it: what the nonlocal onset averages over (methods.md D.6).
///
///   w_p = V_p (1 - |x_p - c|^2 / R^2)^2 / sum,   V_p rest volume, x_p where the formulation takes its weights
///
/// Only particles of one material count, so beyond a surface there is nothing and near it the mean is that of the part
/// inside. A symmetry plane cuts nothing off: the part behind it is the mirror image, with the stress seen in the
/// mirror. Levels do not matter: the cells of all levels that the ball touches are searched.
#pragma once

#include "core/tensor.h"
#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/passes.h"

#include <cstdint>
#include <vector>

namespace transfer
{
/// Particles in a ball with their weights; a particle near a mirror may occur several times.
struct Ball
{
    std::vector<std::uint32_t> particle;
    std::vector<std::uint8_t> turned; // bit a: seen in a mirror normal to axis a
    std::vector<Real> weight;         // any unit: means divide by the sum
};

/// A cell that holds particles.
struct OccupiedCell
{
    int level = 0;
    Index3 index = Index3::Zero(); // on its level
    std::size_t slot = 0;          // leaf * 512 + cell
};

OccupiedCell occupied_cell(const grid::Levels& levels, std::size_t slot);

/// Centre of a cell at rest [mm].
Vec3 centre_of(const grid::Levels& levels, const OccupiedCell& cell);

/// A place as the symmetry planes show it.
struct Seen
{
    Vec3 place;              // mm
    std::uint8_t turned = 0; // bit a: in a mirror normal to axis a
};

/// A vector as it is seen in the mirrors, or back.
inline Vec3 turned_over(std::uint8_t turned, Vec3 vector)
{
    for (int a = 0; a < 3; ++a)
        if ((turned >> a & 1) != 0) vector[a] = -vector[a];
    return vector;
}

/// A place, first, and its images whose surroundings within `reach` [mm] hold something between the planes.
std::vector<Seen> images_of(const PassOptions& options, const grid::Levels& levels, const Vec3& place, Real reach);

/// Occupied cells of all levels with a corner or more within `reach` of a point, in order of level and index, and
/// `margin` cells beyond.
std::vector<OccupiedCell> cells_near(const grid::Levels& levels, const Vec3& point, Real reach, int margin);

/// The ball of `radius` about the centre of a cell, for particles of one material. If it holds none (a ball smaller
/// than the distance of particles), that cell's own particles with equal weights per volume.
/// @param levels  reads cell_start and topology
Ball ball_about(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                const OccupiedCell& cell, std::uint8_t material, Real radius);

/// The particles of one material in a cell, weights their rest volumes [mm^3].
Ball ball_of_cell(const grid::Levels& levels, const particles::Particles& particles, std::size_t slot,
                  std::uint8_t material);

/// The particles of one material in a cell and ahead of it: as far as `length` from the cell's back along the unit
/// vector `way`, and no further than half a cell from the line through its centre. In a cell of `length` or more that
/// cell alone. Weights: rest volumes [mm^3].
Ball ball_ahead(const PassOptions& options, const grid::Levels& levels, const particles::Particles& particles,
                const OccupiedCell& cell, std::uint8_t material, const Vec3& way, Real length);

/// Mean of `stress_at(particle)` over the particles of the ball for which `counts(particle)` [MPa]; zero if none does.
template <class StressAt, class Counts>
core::Sym<Real> mean_stress(const Ball& ball, const StressAt& stress_at, const Counts& counts)
{
    core::Sym<Real> mean{};
    Real total = 0;
    for (std::size_t n = 0; n < ball.particle.size(); ++n) {
        if (!counts(ball.particle[n])) continue;
        total += ball.weight[n];
        const core::Sym<Real> seen = ball.weight[n] * stress_at(ball.particle[n]);
        const unsigned turned = ball.turned[n];
        const auto sign = [&](unsigned a, unsigned b) { return (turned >> a & 1u) == (turned >> b & 1u) ? 1.0 : -1.0; };
        for (int i = 0; i < 3; ++i) mean[i] += seen[i];
        mean[3] += sign(0, 1) * seen[3];
        mean[4] += sign(1, 2) * seen[4];
        mean[5] += sign(2, 0) * seen[5];
    }
    return total > 0 ? (1 / total) * mean : mean;
}
} // namespace transfer
