/// Paths of a material point: each of the six components follows a strain or a stress, segment after segment.
///
/// Within a segment prescribed strains and stresses go linearly from their values at its beginning to their targets.
/// The strains of the stress-controlled components solve sigma_c(d_eps) = target in every step: damped Newton from the
/// elastic answer, tangent by differences of the law itself. Strain is the integral of the rate of deformation in fixed
/// axes, so simple shear is strain xy = gamma/2 with rotation [0, 0, -gamma/2].
#pragma once

#include "solver/point.h"

#include <array>
#include <functional>
#include <string_view>
#include <vector>

namespace solver
{
/// Names of the components in the order of core::Sym.
inline constexpr std::array<std::string_view, 6> component_names{"xx", "yy", "zz", "xy", "yz", "zx"};

struct PointSegment
{
    std::int64_t steps = 1;
    std::array<std::optional<Real>, 6> strain; // 1, at the end of the segment; empty: stress-controlled
    core::Sym<Real> stress{};                  // MPa, at the end, of stress-controlled components
    core::Vec<Real> rotation{};                // 1 (rad), integral of the spin over the segment
};

struct PointPath
{
    material::Material material;
    Real spacing = 0;   // mm
    Real step_time = 0; // ms
    std::vector<PointSegment> segments;
};

/// Follow the path from the unstressed state; `visit` sees every state, the first one included.
/// @error core::NumericalError naming the step if no strain gives the prescribed stresses: softening under stress
///        control, perfect plasticity, a separated crack asked to carry tension
void follow(const PointPath& path, const std::function<void(const PointState&)>& visit);
} // namespace solver
