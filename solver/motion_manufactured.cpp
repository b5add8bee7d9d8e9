/// Manufactured motions: the body force is acceleration - div P / rho_0 with the stress of the program's law.
///
/// Where the principal axes stay, that stress is lambda ln J I + 2 mu ln F; in simple shear kappa it is
/// sigma_21 = mu sin kappa, sigma_22 = -sigma_11 = mu (1 - cos kappa) with 2 along the motion (Jaumann rate).
#include "solver/motion.h"

#include <cmath>
#include <numbers>

namespace solver
{
namespace
{
constexpr Real pi = std::numbers::pi;

core::Sym<Real> symmetric(const Mat3& m)
{
    return {{m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0)}};
}

/// Unit vectors of polar coordinates about an axis, and the radius of a point.
struct Polar
{
    Vec3 radial, around;
    Real radius;

    Polar(const Vec3& centre, int axis, const Vec3& rest)
    {
        radial = rest - centre;
        radial[axis] = 0;
        radius = radial.norm();
        radial = radius > 0 ? Vec3(radial / radius) : Vec3(Vec3::Unit((axis + 1) % 3));
        around = cross_matrix(axis) * radial;
    }
};
} // namespace

MotionState at(const BoxWave& wave, const material::Elastic& elastic, const Vec3& rest, Real time)
{
    const Real c = std::sqrt(elastic.youngs_modulus / elastic.density);
    const Real q = wave.half_waves * pi / wave.edge, omega = pi * c / wave.edge;
    MotionState m;
    Vec3 stretch;
    for (int a = 0; a < 3; ++a) {
        const Real along = q * (rest[a] - wave.corner[a]), turn = pi * wave.phase[a] + omega * time;
        m.displacement[a] = wave.amplitude * std::sin(along) * std::sin(turn);
        m.velocity[a] = wave.amplitude * omega * std::sin(along) * std::cos(turn);
        stretch[a] = 1 + wave.amplitude * q * std::cos(along) * std::sin(turn);
        m.rate(a, a) = wave.amplitude * q * omega * std::cos(along) * std::cos(turn);
    }
    m.deformation = stretch.asDiagonal();
    const Real j = stretch.prod();
    for (int a = 0; a < 3; ++a) {
        m.stress[a] = elastic.lame() * std::log(j) + 2 * elastic.shear_modulus() * std::log(stretch[a]);
        // P_aa = J / F_aa sigma_aa, where J / F_aa does not depend on X_a.
        m.body_force[a] =
            m.displacement[a] *
            (q * q * j / (stretch[a] * stretch[a]) * elastic.wave_modulus() / elastic.density - omega * omega);
    }
    return m;
}

MotionState at(const Vortex& vortex, const material::Elastic& elastic, const Vec3& rest, Real time)
{
    const Polar polar(vortex.centre, vortex.axis, rest);
    const Real r = polar.radius, half = (vortex.outer - vortex.inner) / 2;
    const Real xi = (r - (vortex.inner + vortex.outer) / 2) / half;
    const Real g = (1 - xi * xi) * (1 - xi * xi);
    const Real slope = -4 * xi * (1 - xi * xi) / half, curvature = (12 * xi * xi - 4) / (half * half);
    const Real omega = 2 * pi / vortex.period;
    const Real sine = vortex.angle * std::sin(omega * time), cosine = vortex.angle * omega * std::cos(omega * time);
    const Real angle = sine * g, spin = cosine * g, acceleration = -omega * omega * angle;
    const Real shear = r * sine * slope, shear_rate = r * cosine * slope; // kappa = R d(angle)/dR
    const Real shear_slope = sine * (slope + r * curvature);
    const Real mu = elastic.shear_modulus();

    MotionState m;
    const Mat3 turn = turned_about(vortex.axis, angle);
    const Vec3 radial = turn * polar.radial, around = turn * polar.around;
    m.displacement = r * (radial - polar.radial);
    m.velocity = r * spin * around;
    const Mat3 sheared = Mat3::Identity() + shear * polar.around * polar.radial.transpose();
    m.deformation = turn * sheared;
    m.rate = spin * cross_matrix(vortex.axis) * m.deformation + shear_rate * around * polar.radial.transpose();
    const Real cross = mu * std::sin(shear), normal = mu * (1 - std::cos(shear));
    m.stress = symmetric(normal * (around * around.transpose() - radial * radial.transpose()) +
                         cross * (around * radial.transpose() + radial * around.transpose()));
    const Real divergence_r = -mu * shear_slope * std::sin(shear) - 2 * normal / r;
    const Real divergence_t = mu * shear_slope * std::cos(shear) + 2 * cross / r;
    m.body_force = (-r * spin * spin - divergence_r / elastic.density) * radial +
                   (r * acceleration - divergence_t / elastic.density) * around;
    return m;
}

MotionState at(const Ring& ring, const material::Elastic& elastic, const Vec3& rest, Real time)
{
    const Polar polar(ring.centre, ring.axis, rest);
    const Real ri = ring.inner, ro = ring.outer, r = polar.radius;
    const Real c1 = -6 * ri / (ro * (ro - 3 * ri)), c2 = 3 * (ro + ri) / (ro * ro * (ro - 3 * ri)),
               c3 = -2 / (ro * ro * (ro - 3 * ri));
    const Real omega = pi * std::sqrt(elastic.youngs_modulus / elastic.density) / (ri + ro);
    const Real size = ring.amplitude * std::sin(omega * time), rate = ring.amplitude * omega * std::cos(omega * time);
    const Real shape = ((c3 * r + c2) * r + c1) * r, slope = (3 * c3 * r + 2 * c2) * r + c1;
    const Real curvature = 6 * c3 * r + 2 * c2;
    const Real a = 1 + size * slope, b = 1 + size * shape / r; // F_RR, F_tt
    const Real a_slope = size * curvature, b_slope = size * (slope - shape / r) / r;
    const Real lame = elastic.lame(), two_mu = 2 * elastic.shear_modulus();
    const Real spherical = lame * std::log(a * b);
    const Real stress_r = spherical + two_mu * std::log(a), stress_t = spherical + two_mu * std::log(b);
    const Real stress_slope = (lame + two_mu) * a_slope / a + lame * b_slope / b;
    const Real divergence = stress_slope * b + stress_r * b_slope + (stress_r * b - stress_t * a) / r;

    MotionState m;
    const Vec3 &er = polar.radial, &et = polar.around, ez = Vec3::Unit(ring.axis);
    m.displacement = size * shape * er;
    m.velocity = rate * shape * er;
    m.deformation += (a - 1) * er * er.transpose() + (b - 1) * et * et.transpose();
    m.rate = rate * slope * er * er.transpose() + rate * shape / r * et * et.transpose();
    m.stress =
        symmetric(stress_r * er * er.transpose() + stress_t * et * et.transpose() + spherical * ez * ez.transpose());
    m.body_force = (-omega * omega * size * shape - divergence / elastic.density) * er;
    return m;
}
} // namespace solver
