/// One particle's vectors and tensors gathered from their columns, for code that looks at particles one by one.
#pragma once

#include "core/tensor.h"
#include "particles/particles.h"

namespace particles
{
/// Position at time 0 [mm].
inline Vec3 rest_of(const Particles& particles, std::size_t p)
{
    return {particles.rest_position[0][p], particles.rest_position[1][p], particles.rest_position[2][p]};
}

/// Cauchy stress [MPa].
inline core::Sym<Real> stress_of(const Particles& particles, std::size_t p)
{
    core::Sym<Real> s{};
    for (std::size_t n = 0; n < 6; ++n) s.s[n] = particles.stress[n][p];
    return s;
}

/// Deformation gradient [1]; total formulation only.
inline core::Mat<Real> deformation_of(const Particles& particles, std::size_t p)
{
    core::Mat<Real> f{};
    for (std::size_t n = 0; n < 9; ++n) f.m[n] = particles.deformation_gradient[n][p];
    return f;
}
} // namespace particles
