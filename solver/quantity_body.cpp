#include "solver/quantity_values.h"

#include "particles/tensors.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace solver
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

Vec3 position_of(const particles::Particles& particles, std::size_t p)
{
    return {particles.position[0][p], particles.position[1][p], particles.position[2][p]};
}

/// Half width of a particle along a unit vector: that of its sub-cube, s (chi - 1/2) where the surface cut it to the
/// share chi, stretched by F (updated formulation: J^(1/3)).
Real half_width(const ParticleView& view, std::size_t p, const Vec3& direction)
{
    const particles::Particles& particles = view.particles;
    const Real side = view.levels.spacing(particles.size_level[p]) / view.per_axis;
    const Real share = std::min(Real(1), particles.rest_volume[p] / (side * side * side));
    Real stretch = std::cbrt(volume_ratio(particles, p));
    if (particles.volume_ratio.empty()) {
        const core::Mat<Real> f = particles::deformation_of(particles, p);
        Vec3 along = Vec3::Zero();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) along[j] += direction[i] * f(i, j);
        stretch = along.norm();
    }
    return side * (share - Real(0.5)) * stretch;
}
} // namespace

Real value_of(const Extent& extent, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    const Vec3 axis = Vec3::Unit(extent.axis);
    Real upper = -infinity, lower = infinity, radius = -infinity;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (extent.body && particles.body[p] != *extent.body) continue;
        if (!extent.region.contains(rest_of(particles, p))) continue;
        const Vec3 x = position_of(particles, p);
        if (extent.what == Extent::What::radius) {
            Vec3 arm = x - extent.centre;
            arm[extent.axis] = 0;
            const Real distance = arm.norm();
            const Vec3 outward = distance > 0 ? Vec3(arm / distance) : Vec3(Vec3::Unit((extent.axis + 1) % 3));
            radius = std::max(radius, distance + half_width(view, p, outward));
        } else {
            const Real half = half_width(view, p, axis);
            upper = std::max(upper, x[extent.axis] + half);
            lower = std::min(lower, x[extent.axis] - half);
        }
    }
    if (std::max(radius, upper) == -infinity) return std::numeric_limits<Real>::quiet_NaN();
    switch (extent.what) {
    case Extent::What::length:
        return upper - lower;
    case Extent::What::upper:
        return upper;
    case Extent::What::lower:
        return lower;
    case Extent::What::radius:
        break;
    }
    return radius;
}

Real value_of(const Momentum& momentum, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 carried =
            particles.mass[p] * Vec3(particles.velocity[0][p], particles.velocity[1][p], particles.velocity[2][p]);
        sum += momentum.angular ? Vec3((position_of(particles, p) - momentum.centre).cross(carried)) : carried;
    }
    return sum[momentum.axis];
}

Real value_of(const Volume& volume, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    Real sum = 0;
    for (std::size_t p = 0; p < particles.size(); ++p)
        if (volume.region.contains(rest_of(particles, p))) sum += particles.rest_volume[p] * volume_ratio(particles, p);
    return sum;
}

Real value_of(const Energy& energy, const Ledger& ledger)
{
    switch (energy.what) {
    case Energy::What::kinetic:
        return ledger.kinetic;
    case Energy::What::elastic:
        return ledger.elastic;
    case Energy::What::plastic:
        return ledger.plastic;
    case Energy::What::decohesion:
        return ledger.decohesion;
    case Energy::What::external:
        return ledger.external;
    case Energy::What::damping:
        return ledger.damping;
    case Energy::What::residual:
        return ledger.residual();
    case Energy::What::residual_share:
        return ledger.residual() / (ledger.external + ledger.initial);
    case Energy::What::total:
        break;
    }
    return ledger.kinetic + ledger.elastic;
}
} // namespace solver
