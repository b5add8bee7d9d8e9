#include "solver/quantity_values.h"

#include "core/equivalent_stress.h"
#include "core/parallel.h"
#include "core/tensor.h"
#include "particles/tensors.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

namespace solver
{
namespace
{
using Field = FieldComponent::Field;
using Component = FieldComponent::Component;

constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();

/// Radial and tangential unit vectors at a particle's present place.
struct Directions
{
    Vec3 radial, around;

    Directions(const FieldComponent& field, const particles::Particles& particles, std::size_t p)
    {
        for (int a = 0; a < 3; ++a) radial[a] = particles.position[static_cast<std::size_t>(a)][p] - field.centre[a];
        radial[field.axis] = 0;
        if (radial.norm() > 0) radial.normalize();
        around = cross_matrix(field.axis) * radial;
    }
};

Real vector_component(const FieldComponent& field, const Vec3& v, const particles::Particles& particles, std::size_t p)
{
    switch (field.component) {
    case Component::x:
    case Component::y:
    case Component::z:
        return v[static_cast<int>(field.component)];
    case Component::radial:
        return v.dot(Directions(field, particles, p).radial);
    case Component::around:
        return v.dot(Directions(field, particles, p).around);
    default:
        return v.norm();
    }
}

Mat3 matrix_of(const core::Sym<Real>& s)
{
    Mat3 m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = s(i, j);
    return m;
}

Real stress_component(const FieldComponent& field, const core::Sym<Real>& s, const particles::Particles& particles,
                      std::size_t p)
{
    switch (field.component) {
    case Component::xx:
    case Component::yy:
    case Component::zz:
    case Component::xy:
    case Component::yz:
    case Component::zx:
        return s.s[static_cast<std::size_t>(field.component) - static_cast<std::size_t>(Component::xx)];
    case Component::first:
        return Eigen::SelfAdjointEigenSolver<Mat3>(matrix_of(s), Eigen::EigenvaluesOnly).eigenvalues()[2];
    default:
        break;
    }
    const Directions at(field, particles, p);
    const Vec3 on_radial = matrix_of(s) * at.radial;
    if (field.component == Component::radial) return at.radial.dot(on_radial);
    if (field.component == Component::radial_around) return at.around.dot(on_radial);
    return at.around.dot(matrix_of(s) * at.around);
}

/// Linear fit of the field over the particles within `radius` of a point, evaluated there. Directions in which the
/// particles do not differ count as constant.
Real fitted(const FieldComponent& field, const Vec3& point, std::optional<Real> radius, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    std::size_t nearest = 0;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Real distance = (rest_of(particles, p) - point).norm();
        if (distance < least) {
            least = distance;
            nearest = p;
        }
    }
    if (particles.size() == 0) return nothing;
    const Real reach =
        std::max(radius.value_or(Real(1.5) * view.levels.spacing(particles.size_level[nearest])), least * (1 + 1e-9));
    std::vector<std::size_t> around;
    for (std::size_t p = 0; p < particles.size(); ++p)
        if ((rest_of(particles, p) - point).norm() <= reach) around.push_back(p);
    // In id order, so that the sums do not depend on the present order of particles.
    std::sort(around.begin(), around.end(),
              [&](std::size_t a, std::size_t b) { return particles.id[a] < particles.id[b]; });
    Vec3 middle = Vec3::Zero();
    Real mean = 0;
    for (const std::size_t p : around) {
        middle += rest_of(particles, p) / static_cast<Real>(around.size());
        mean += field_value(field, particles, p) / static_cast<Real>(around.size());
    }
    Eigen::MatrixXd arm(around.size(), 3);
    Eigen::VectorXd rise(around.size());
    for (std::size_t n = 0; n < around.size(); ++n) {
        arm.row(static_cast<Eigen::Index>(n)) = (rest_of(particles, around[n]) - middle) / reach;
        rise[static_cast<Eigen::Index>(n)] = field_value(field, particles, around[n]) - mean;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> fit(arm.rows(), arm.cols());
    fit.setThreshold(1e-6);
    fit.compute(arm);
    return mean + fit.solve(rise).dot((point - middle) / reach);
}

Real over_region(const Probe& probe, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    Real sum = 0, volume = 0;
    Real largest = -std::numeric_limits<Real>::infinity(), smallest = -largest;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (!probe.region.contains(rest_of(particles, p))) continue;
        const Real value = field_value(probe.field, particles, p);
        const Real weight = particles.rest_volume[p] * volume_ratio(particles, p);
        sum += weight * value;
        volume += weight;
        largest = std::max(largest, value);
        smallest = std::min(smallest, value);
    }
    if (volume <= 0) return nothing;
    if (probe.over == Probe::Over::mean) return sum / volume;
    return probe.over == Probe::Over::max ? largest : smallest;
}
} // namespace

Real volume_ratio(const particles::Particles& particles, std::size_t p)
{
    return particles.volume_ratio.empty() ? core::determinant(particles::deformation_of(particles, p))
                                          : particles.volume_ratio[p];
}

Real field_value(const FieldComponent& field, const particles::Particles& particles, std::size_t p)
{
    const auto vector_at = [&](const std::array<particles::Column, 3>& columns) {
        return Vec3(columns[0][p], columns[1][p], columns[2][p]);
    };
    switch (field.field) {
    case Field::displacement:
        return vector_component(field, vector_at(particles.position) - rest_of(particles, p), particles, p);
    case Field::velocity:
        return vector_component(field, vector_at(particles.velocity), particles, p);
    case Field::position:
        return vector_component(field, vector_at(particles.position), particles, p);
    case Field::stress:
        return stress_component(field, particles::stress_of(particles, p), particles, p);
    case Field::von_mises:
        return core::equivalent_stress(particles::stress_of(particles, p));
    case Field::pressure:
        return -core::trace(particles::stress_of(particles, p)) / 3;
    case Field::eq_plastic_strain:
        return particles.eq_plastic_strain[p];
    case Field::damage:
        return particles.crack[p] < 0 ? Real(0) : particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage;
    }
    return nothing;
}

Real value_of(const Probe& probe, const ParticleView& view)
{
    return probe.point ? fitted(probe.field, *probe.point, probe.radius, view) : over_region(probe, view);
}

Real value_of(const Difference& difference, const ParticleView& view)
{
    return fitted(difference.field, difference.first, difference.radius, view) -
           fitted(difference.field, difference.second, difference.radius, view);
}

Real value_of(const FieldError& error, const Problem& problem, const Clock& clock, const ParticleView& view)
{
    const particles::Particles& particles = view.particles;
    const bool of_velocity = error.field == Field::velocity;
    const Motion& motion = problem.motions[error.motion];
    // Velocities are those of the middle of the step of their level.
    const auto time_of = [&](std::size_t p) {
        const int parts = problem.numerics.subcycling ? 1 << particles.size_level[p] : 1;
        return of_velocity ? clock.time - clock.dt / (2 * parts) : clock.time;
    };
    std::vector<Real> squared(particles.size(), -1); // -1: outside of the region
    core::parallel_for(particles.size(), [&](std::size_t p) {
        const Vec3 rest = rest_of(particles, p);
        if (!error.region.contains(rest)) return;
        const MotionState exact = at(motion, rest, time_of(p));
        if (error.field == Field::stress) {
            const Mat3 off = matrix_of(particles::stress_of(particles, p)) - matrix_of(exact.stress);
            squared[p] = off.squaredNorm();
            return;
        }
        Vec3 off = of_velocity ? Vec3(-exact.velocity) : Vec3(-exact.displacement - rest);
        const auto& columns = of_velocity ? particles.velocity : particles.position;
        for (int a = 0; a < 3; ++a) off[a] += columns[static_cast<std::size_t>(a)][p];
        squared[p] = off.squaredNorm();
    });
    Real sum = 0, volume = 0, largest = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (squared[p] < 0) continue;
        sum += particles.rest_volume[p] * squared[p];
        volume += particles.rest_volume[p];
        largest = std::max(largest, squared[p]);
    }
    if (volume <= 0) return nothing;
    return std::sqrt(error.norm == FieldError::Norm::l2 ? sum / volume : largest);
}
} // namespace solver
