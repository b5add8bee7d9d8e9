#include "solver/motion.h"

#include <Eigen/Geometry>

namespace solver
{
MotionState at(const Motion& motion, const Vec3& rest, Real time)
{
    return std::visit([&](const auto& kind) { return at(kind, motion.elastic, rest, time); }, motion.kind);
}

Mat3 turned_about(int axis, Real angle)
{
    return Eigen::AngleAxis<Real>(angle, Vec3::Unit(axis)).toRotationMatrix();
}

Mat3 cross_matrix(int axis)
{
    Mat3 m = Mat3::Zero();
    m((axis + 2) % 3, (axis + 1) % 3) = 1;
    m((axis + 1) % 3, (axis + 2) % 3) = -1;
    return m;
}

MotionState at(const Spin& spin, const material::Elastic&, const Vec3& rest, Real time)
{
    MotionState m;
    const Mat3 turn = turned_about(spin.axis, spin.omega * time);
    const Vec3 arm = turn * (rest - spin.centre);
    const Vec3 around = spin.omega * Vec3(Vec3::Unit(spin.axis)).cross(arm);
    m.displacement = spin.centre + arm + time * spin.velocity - rest;
    m.velocity = spin.velocity + around;
    m.deformation = turn;
    m.rate = spin.omega * cross_matrix(spin.axis) * turn;
    m.body_force = spin.omega * Vec3(Vec3::Unit(spin.axis)).cross(around);
    return m;
}
} // namespace solver
