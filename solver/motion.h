/// Motions known in closed form: initial states, body forces that keep them going, and what errors are measured
/// against.
///
/// A closed list, one file per family. The stresses are those of the program's own law (Hughes-Winget rotation with
/// constant moduli), so body forces of manufactured solutions are exact for it at any amplitude (decision 016).
#pragma once

#include "core/real.h"
#include "core/tensor.h"
#include "material/material.h"

#include <Eigen/Core>

#include <string>
#include <variant>

namespace solver
{
using Mat3 = Eigen::Matrix<Real, 3, 3>;

/// A motion at one material point and time.
struct MotionState
{
    Vec3 displacement = Vec3::Zero();    // mm
    Vec3 velocity = Vec3::Zero();        // mm/ms
    Mat3 deformation = Mat3::Identity(); // 1, F
    Mat3 rate = Mat3::Zero();            // 1/ms, dF/dt
    core::Sym<Real> stress{};            // MPa, Cauchy
    Vec3 body_force = Vec3::Zero();      // mm/ms^2, acceleration - div P / rho_0
};

/// Rigid rotation about an axis through `centre`, on top of a translation. Free of stress: a body that only begins with
/// it and has no body force begins to stretch.
struct Spin
{
    Vec3 centre = Vec3::Zero(); // mm
    int axis = 2;
    Real omega = 0;               // rad/ms
    Vec3 velocity = Vec3::Zero(); // mm/ms, of the centre
};

/// Modulus a small-amplitude wave feels.
enum class WaveKind
{
    bar,   // E: stress in one direction
    plane, // lambda + 2 mu: strain in one direction
    shear, // mu
};

/// v = v_0 sin(k (x - start) + phase) cos(omega t) along `direction`, small amplitude.
struct StandingWave
{
    int axis = 0;      // along which it varies
    int direction = 0; // of the motion; WaveKind shear: another one
    WaveKind wave = WaveKind::bar;
    Real wavelength = 0; // mm
    Real start = 0;      // mm
    Real phase = 0;      // rad
    Real speed = 0;      // mm/ms, v_0
};

/// Gaussian packet that runs towards +axis, small amplitude: u = U exp(-s^2 / 2 w^2) sin(k s), s = x - start - c t.
struct Packet
{
    int axis = 0;
    int direction = 0;
    WaveKind wave = WaveKind::bar;
    Real wavelength = 0; // mm
    Real width = 0;      // mm, w
    Real start = 0;      // mm, centre at time 0
    Real speed = 0;      // mm/ms, velocity amplitude -c k U
};

/// Manufactured: u_k = A sin(q X_k) sin(pi (phase_k + c t / L)), q = half_waves pi / L, X from `corner`, c = sqrt(E /
/// rho) (methods.md C1). Normal displacements vanish on the faces of the cube of edge L.
struct BoxWave
{
    Vec3 corner = Vec3::Zero(); // mm
    Real edge = 1;              // mm
    Real amplitude = 0;         // mm
    int half_waves = 1;
    Vec3 phase{0, 2.0 / 3, 4.0 / 3}; // half turns
};

/// Manufactured: every circle about the axis turns by alpha = A sin(2 pi t / T) g(R), g = (1 - xi^2)^2, xi the distance
/// from the middle radius over half the width, so both rims are free (methods.md C3).
struct Vortex
{
    Vec3 centre = Vec3::Zero(); // mm
    int axis = 2;
    Real inner = 0, outer = 0; // mm
    Real angle = 0;            // rad, A
    Real period = 0;           // ms, T
};

/// Manufactured: ring that breathes, u_R = A sin(pi c t / 2 r_b) (c_3 R^3 + c_2 R^2 + c_1 R), with free rims for
/// Poisson ratio 0 (methods.md C2).
struct Ring
{
    Vec3 centre = Vec3::Zero(); // mm
    int axis = 2;
    Real inner = 0, outer = 0; // mm
    Real amplitude = 0;        // mm
};

struct Motion
{
    std::string name;
    material::Elastic elastic;
    std::variant<Spin, StandingWave, Packet, BoxWave, Vortex, Ring> kind;
};

/// @param rest  mm, rest position
/// @param time  ms
MotionState at(const Motion& motion, const Vec3& rest, Real time);

MotionState at(const Spin& spin, const material::Elastic& elastic, const Vec3& rest, Real time);
MotionState at(const StandingWave& wave, const material::Elastic& elastic, const Vec3& rest, Real time);
MotionState at(const Packet& packet, const material::Elastic& elastic, const Vec3& rest, Real time);
MotionState at(const BoxWave& wave, const material::Elastic& elastic, const Vec3& rest, Real time);
MotionState at(const Vortex& vortex, const material::Elastic& elastic, const Vec3& rest, Real time);
MotionState at(const Ring& ring, const material::Elastic& elastic, const Vec3& rest, Real time);

/// Q(angle) about a coordinate axis.
Mat3 turned_about(int axis, Real angle);
/// axis x v as a matrix.
Mat3 cross_matrix(int axis);
} // namespace solver
