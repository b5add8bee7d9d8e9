/// Plane waves of small amplitude: what is quadratic in it is neglected, so there is no body force.
#include "solver/motion.h"

#include <cmath>
#include <numbers>

namespace solver
{
namespace
{
Real modulus(WaveKind wave, const material::Elastic& elastic)
{
    switch (wave) {
    case WaveKind::bar:
        return elastic.youngs_modulus;
    case WaveKind::plane:
        return elastic.wave_modulus();
    case WaveKind::shear:
        break;
    }
    return elastic.shear_modulus();
}

/// Displacement, its derivative along `axis`, velocity and its derivative into a state.
MotionState plane_state(int axis, int direction, WaveKind wave, const material::Elastic& elastic, Real displacement,
                        Real slope, Real velocity, Real velocity_slope)
{
    MotionState m;
    m.displacement[direction] = displacement;
    m.velocity[direction] = velocity;
    m.deformation(direction, axis) += slope;
    m.rate(direction, axis) = velocity_slope;
    m.stress.s[static_cast<std::size_t>(core::Sym<Real>::at(direction, axis))] = modulus(wave, elastic) * slope;
    if (wave == WaveKind::plane)
        for (const int side : {(axis + 1) % 3, (axis + 2) % 3})
            m.stress.s[static_cast<std::size_t>(side)] = elastic.lame() * slope;
    if (wave == WaveKind::bar)
        for (const int side : {(axis + 1) % 3, (axis + 2) % 3})
            m.deformation(side, side) -= elastic.poisson_ratio * slope;
    return m;
}
} // namespace

MotionState at(const StandingWave& wave, const material::Elastic& elastic, const Vec3& rest, Real time)
{
    const Real k = 2 * std::numbers::pi / wave.wavelength;
    const Real omega = k * std::sqrt(modulus(wave.wave, elastic) / elastic.density);
    const Real sine = std::sin(k * (rest[wave.axis] - wave.start) + wave.phase);
    const Real cosine = std::cos(k * (rest[wave.axis] - wave.start) + wave.phase);
    const Real u = wave.speed / omega * std::sin(omega * time), v = wave.speed * std::cos(omega * time);
    return plane_state(wave.axis, wave.direction, wave.wave, elastic, u * sine, u * k * cosine, v * sine,
                       v * k * cosine);
}

MotionState at(const Packet& packet, const material::Elastic& elastic, const Vec3& rest, Real time)
{
    const Real k = 2 * std::numbers::pi / packet.wavelength;
    const Real c = std::sqrt(modulus(packet.wave, elastic) / elastic.density);
    const Real s = rest[packet.axis] - packet.start - c * time;
    const Real per_width = 1 / (packet.width * packet.width);
    const Real size = -packet.speed / (c * k) * std::exp(-s * s * per_width / 2);
    const Real sine = std::sin(k * s), cosine = std::cos(k * s), drop = s * per_width;
    const Real slope = size * (k * cosine - drop * sine);
    const Real curvature = size * ((drop * drop - per_width - k * k) * sine - 2 * drop * k * cosine);
    return plane_state(packet.axis, packet.direction, packet.wave, elastic, size * sine, slope, -c * slope,
                       -c * curvature);
}
} // namespace solver
