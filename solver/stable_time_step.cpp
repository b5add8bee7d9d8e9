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

/// The fastest signal of a leaf.
struct Signal
{
    Real speed = 0;           // mm/ms, c_d s + |v|
    std::size_t particle = 0; // where
};

[[noreturn]] void collapsed(const Prepared& prepared, const State& state, const Signal& signal, Real dt, Real at_rest)
{
    const particles::Particles& particles = state.particles;
    const bool total = prepared.options.formulation == Formulation::total;
    const auto& place = total ? particles.rest_position : particles.position;
    const std::size_t p = signal.particle;
    const std::string cause =
        total
            ? fmt::format("the material there is squeezed so far that waves pass it {:.0f} times as fast as at rest, "
                          "further than the total formulation can follow: coarser cells, the updated formulation or a "
                          "crack model may help",
                          signal.speed / prepared.wave_speed)
            : fmt::format("it moves at {:.3g} mm/ms, the speed of sound is {:.4g} mm/ms: the computation is unstable, "
                          "try numerics.stress_update = \"musl\" or a smaller numerics.cfl",
                          signal.speed - prepared.wave_speed, prepared.wave_speed);
    throw core::NumericalError(fmt::format(
        "the stable time step has fallen to {:.3g} ms, {:.0e} of that at rest, at step {}, t = {:.6g} ms: particle {} "
        "{} ({:.4g}, {:.4g}, {:.4g}) mm, level {}: {}.",
        dt, dt / at_rest, state.clock.step, state.clock.time, particles.id[p], total ? "from" : "at", place[0][p],
        place[1][p], place[2][p], particles.size_level[p], cause));
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
    const Real squeeze = std::sqrt(transfer::cell_stiffening(particles::deformation_of(particles, p)));
    if (!std::isfinite(squeeze)) not_finite(state, p);
    return prepared.wave_speed * std::max(Real(1), squeeze);
}

/// The fastest signal of every leaf, from nodes that carry the motion.
std::vector<Signal> fastest_on_lattice(const Prepared& prepared, const State& state)
{
    std::vector<transfer::LatticeSurvey> survey;
    transfer::survey_squeeze(prepared.laws, state.lattice, state.particles, state.levels, survey);
    std::vector<Signal> fastest(survey.size());
    for (std::size_t n = 0; n < survey.size(); ++n) {
        if (!std::isfinite(survey[n].squeeze)) not_finite(state, survey[n].worst);
        fastest[n] = {prepared.wave_speed * std::max(Real(1), survey[n].squeeze), survey[n].worst};
    }
    return fastest;
}

std::vector<Signal> fastest_of_particles(const Prepared& prepared, const State& state)
{
    const grid::Levels& levels = state.levels;
    std::vector<Signal> fastest(levels.leaves.size());
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        for (std::uint32_t p = levels.cell_start[n * grid::leaf_cells];
             p < levels.cell_start[(n + 1) * grid::leaf_cells]; ++p) {
            const Real speed = signal_speed(prepared, state, p);
            if (speed > fastest[n].speed) fastest[n] = {speed, p};
        }
    });
    return fastest;
}
} // namespace

Real stable_time_step(const Problem& problem, const Prepared& prepared, const State& state)
{
    const grid::Levels& levels = state.levels;
    const std::vector<Signal> fastest = prepared.options.transfer == Transfer::nodal
                                            ? fastest_on_lattice(prepared, state)
                                            : fastest_of_particles(prepared, state);
    const bool subcycling = problem.numerics.subcycling;
    const Real finest = levels.spacing(levels.count - 1);
    const Real share = uses_boxes(prepared.options) ? transfer::box_step_share(prepared.per_axis)
                       : subcycling                 ? subcycled_step_share
                                                    : transfer::deformed_step_share;
    const Real at_rest = problem.numerics.cfl * finest / prepared.wave_speed;
    Real dt = at_rest;
    std::size_t tightest = 0; // leaf
    for (std::size_t n = 0; n < fastest.size(); ++n) {
        if (fastest[n].speed <= 0) continue;
        // Sub-cycled steps grow with the spacing.
        const Real spacing = subcycling ? finest : levels.spacing(levels.leaves[n].level);
        const Real held = share * spacing / fastest[n].speed;
        if (held >= dt) continue;
        dt = held;
        tightest = n;
    }
    if (dt < smallest_step_share * at_rest) collapsed(prepared, state, fastest[tightest], dt, at_rest);
    return dt;
}
} // namespace solver
