#include "solver/stable_time_step.h"

#include "core/error.h"
#include "core/parallel.h"
#include "particles/tensors.h"
#include "transfer/cell_squeeze.h"
#include "transfer/gimp_box.h"
#include "transfer/lattice_squeeze.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace solver
{
namespace
{
[[noreturn]] void not_finite(const State& state, std::size_t p)
{
    throw core::NumericalError(fmt::format(
        "particle {} has no finite motion at step {}, t = {:.6g} ms: the computation is unstable. Try a smaller "
        "numerics.cfl, or restart from the last checkpoint.",
        state.particles.id[p], state.clock.step, state.clock.time));
}

/// c_d s + |v| of one particle [mm/ms].
Real signal_speed(const Prepared& prepared, const State& state, std::size_t p)
{
    const particles::Particles& particles = state.particles;
    Real squared = 0; // not std::hypot, which drops a NaN beside two zeros
    for (const particles::Column& v : particles.velocity) squared += v[p] * v[p];
    const Real speed = std::sqrt(squared);
    if (!std::isfinite(speed)) not_finite(state, p);
    if (prepared.options.formulation == Formulation::updated) return prepared.wave_speed + speed;
    const std::int32_t crack = particles.crack[p];
    if (crack >= 0 && particles.cracks[static_cast<std::size_t>(crack)].damage >= 1) return prepared.wave_speed;
    const Real squeeze = transfer::cell_squeeze(particles::deformation_of(particles, p));
    if (!std::isfinite(squeeze)) not_finite(state, p);
    return prepared.wave_speed * std::max(Real(1), squeeze);
}
/// c_d s of every leaf, from nodes that carry the motion.
std::vector<Real> fastest_on_lattice(const Prepared& prepared, const State& state)
{
    std::vector<transfer::LatticeSurvey> survey;
    transfer::survey_squeeze(prepared.laws, state.lattice, state.particles, state.levels, survey);
    std::vector<Real> fastest(survey.size(), 0);
    for (std::size_t n = 0; n < survey.size(); ++n) {
        if (!std::isfinite(survey[n].squeeze)) not_finite(state, survey[n].worst);
        fastest[n] = prepared.wave_speed * std::max(Real(1), survey[n].squeeze);
    }
    return fastest;
}

std::vector<Real> fastest_of_particles(const Prepared& prepared, const State& state)
{
    const grid::Levels& levels = state.levels;
    std::vector<Real> fastest(levels.leaves.size(), 0);
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        for (std::uint32_t p = levels.cell_start[n * grid::leaf_cells];
             p < levels.cell_start[(n + 1) * grid::leaf_cells]; ++p)
            fastest[n] = std::max(fastest[n], signal_speed(prepared, state, p));
    });
    return fastest;
}
} // namespace

Real stable_time_step(const Problem& problem, const Prepared& prepared, const State& state)
{
    const grid::Levels& levels = state.levels;
    const std::vector<Real> fastest = prepared.options.transfer == Transfer::nodal
                                          ? fastest_on_lattice(prepared, state)
                                          : fastest_of_particles(prepared, state);
    const bool subcycling = problem.numerics.subcycling;
    const Real finest = levels.spacing(levels.count - 1);
    const Real share = uses_boxes(prepared.options) ? transfer::box_step_share(prepared.per_axis)
                       : subcycling                 ? subcycled_step_share
                                                    : transfer::deformed_step_share;
    Real dt = problem.numerics.cfl * finest / prepared.wave_speed;
    for (std::size_t n = 0; n < fastest.size(); ++n) {
        if (fastest[n] <= 0) continue;
        // Sub-cycled steps grow with the spacing.
        const Real spacing = subcycling ? finest : levels.spacing(levels.leaves[n].level);
        dt = std::min(dt, share * spacing / fastest[n]);
    }
    return dt;
}
} // namespace solver
