#include "solver/quantity_values.h"

#include "material/decohesion.h"
#include "particles/tensors.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace solver
{
namespace
{
using Pair = Eigen::Vector2d;

/// Rest positions of separated particles in the plane normal to an axis.
std::vector<Pair> separated_in_plane(const CrackQuantity& crack, const particles::Particles& particles)
{
    std::vector<Pair> places;
    const int u = (crack.axis + 1) % 3, v = (crack.axis + 2) % 3;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.crack[p] < 0 || particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage < 1)
            continue;
        const Vec3 rest = rest_of(particles, p);
        if (crack.region.contains(rest)) places.emplace_back(rest[u], rest[v]);
    }
    return places;
}

/// Unit vector of the line through the places (least squares of the distance), first component not negative.
Pair direction_of(const std::vector<Pair>& places)
{
    Pair middle = Pair::Zero();
    for (const Pair& place : places) middle += place / static_cast<Real>(places.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Pair& place : places) spread += (place - middle) * (place - middle).transpose();
    const Pair along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
    return along[0] < 0 ? Pair(-along) : along;
}

Real line_value(const CrackQuantity& crack, const particles::Particles& particles)
{
    const std::vector<Pair> places = separated_in_plane(crack, particles);
    if (places.size() < 2) return std::numeric_limits<Real>::quiet_NaN();
    const Pair along = direction_of(places);
    if (crack.what == CrackQuantity::What::angle) {
        const Real angle = std::atan2(along[1], along[0]) * 180 / std::numbers::pi;
        return angle < -90 + 1e-6 ? Real(90) : angle; // rounding decides the sign of a line along the second axis
    }
    Real lower = std::numeric_limits<Real>::infinity(), upper = -lower;
    for (const Pair& place : places) {
        lower = std::min(lower, along.dot(place));
        upper = std::max(upper, along.dot(place));
    }
    return upper - lower;
}

/// What grows with every particle that has decohesion state.
struct Sums
{
    Real separated = 0;                                      // 1
    Real volume = 0;                                         // mm^3
    Real area = 0;                                           // mm^2
    Real softening = 0;                                      // mJ
    Real tip = -std::numeric_limits<Real>::infinity();       // mm
    Real onset_time = std::numeric_limits<Real>::infinity(); // ms
};

Sums sums_of(const CrackQuantity& crack, const std::vector<material::Material>& materials,
             const particles::Particles& particles)
{
    Sums sums;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.crack[p] < 0) continue;
        const Vec3 rest = rest_of(particles, p);
        if (!crack.region.contains(rest)) continue;
        const core::Crack& state = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
        sums.onset_time = std::min(sums.onset_time, state.onset_time);
        if (state.effective_length > 0) {
            const Real area = particles.rest_volume[p] / state.effective_length;
            sums.area += std::min(Real(1), state.damage) * area;
            sums.softening += area * material::softening_energy(materials[particles.material[p]].decohesion->q, state);
        }
        if (state.damage < 1) continue;
        sums.separated += 1;
        sums.volume += particles.rest_volume[p];
        sums.tip = std::max(sums.tip, rest[crack.axis]);
    }
    return sums;
}
} // namespace

Real value_of(const CrackQuantity& crack, const std::vector<material::Material>& materials,
              const particles::Particles& particles)
{
    using enum CrackQuantity::What;
    if (crack.what == angle || crack.what == length) return line_value(crack, particles);
    const Sums sums = sums_of(crack, materials, particles);
    const auto if_any = [](Real value) {
        return std::isfinite(value) ? value : std::numeric_limits<Real>::quiet_NaN();
    };
    switch (crack.what) {
    case softening:
        return sums.softening;
    case separated:
        return sums.separated;
    case volume:
        return sums.volume;
    case area:
        return sums.area;
    case tip:
        return if_any(sums.tip);
    default:
        return if_any(sums.onset_time);
    }
}
} // namespace solver
