/// What a run measures while it goes: force, opening, energies.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"
#include "solver/step.h"

namespace solver
{
/// Change of the gauge length since time 0 [mm]: mean displacement of the upper minus that of the lower particles.
Real gauge_opening(const Problem& problem, const State& state, const Derived& derived);

/// Make a history line of the present state: mean forces since the last line, opening, energies. Resets the impulses,
/// appends the line to state.history and what happened on the ligaments to state.events.
HistoryLine observe(const Problem& problem, const Prepared& prepared, const Derived& derived, State& state);

/// Number of particles on each level.
std::vector<std::uint64_t> particles_per_level(const State& state);

/// Particles advanced in one step, counted as often as they are: with sub-cycling those of finer levels several times.
std::uint64_t updates_per_step(const Problem& problem, const State& state);

enum class Finish
{
    no,
    time,      // end.time reached
    cod,       // end.cod reached
    separated, // the loads carry nothing any more
};

/// Force below this share of the peak counts as nothing.
inline constexpr Real separated_share = 0.01;

/// Whether the run has reached its end, judged by the clock and the last history line.
Finish finished(const Problem& problem, const State& state);
} // namespace solver
