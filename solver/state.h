/// Everything that changes during a run. Only `step`, the dt rule, audits and restart see the whole of it.
#pragma once

#include "grid/levels.h"
#include "particles/particles.h"
#include "transfer/lattice.h"
#include "transfer/passes.h"

#include <cstdint>
#include <string>
#include <vector>

namespace solver
{
struct Clock
{
    std::int64_t step = 0; // of the coarsest level
    Real time = 0;         // ms
    Real dt = 0;           // ms, of the last step
};

/// Motion and reaction of one load (same order as Problem::loads).
struct LoadState
{
    Vec3 displacement = Vec3::Zero();   // mm, prescribed part
    Real angle = 0;                     // rad, of a pin
    Real spin = 0;                      // rad/ms, of a pin
    Vec3 reaction = Vec3::Zero();       // N, last step (substep): force of the load on the body, modelled part
    Vec3 impulse = Vec3::Zero();        // N ms, since the last history line
    Real impulse_time = 0;              // ms, time it was gathered over
    Vec3 sample_impulse = Vec3::Zero(); // N ms, since the measures were last sampled
    Real sample_time = 0;               // ms, time it was gathered over
    Real external_work = 0;             // mJ, since time 0
};

/// Energies of the modelled part [mJ]; `damping` is what damping took. `residual` = external + initial - all
/// the rest: what the scheme lost (> 0) or made.
struct Ledger
{
    Real kinetic = 0;
    Real elastic = 0;
    Real plastic = 0;
    Real decohesion = 0;
    Real external = 0;
    Real initial = 0;
    Real damping = 0;
    Real residual() const { return external + initial - kinetic - elastic - plastic - decohesion - damping; }
};

/// Dissipation summed per leaf inside the kernels; folded into State when leaves are renumbered.
using transfer::LeafWork;

/// What happened on one ligament (same order as Problem::ligaments); negative time: not yet.
struct LigamentState
{
    Real onset_time = -1, onset_force = 0, onset_cod = 0; // first particle with damage > 0 in the corridor
    Real first_time = -1, first_force = 0, first_cod = 0; // first through-broken column, at the latest when through
    Real through_time = -1, through_force = 0, through_cod = 0; // broken columns or layers join the features
    Real front = 0;                                             // 1, share of the ligament's columns broken
};

enum class EventKind : std::int32_t
{
    onset,   // first particle with damage > 0 in the corridor
    first,   // first through-broken column, at the latest when through
    front,   // the crack front has passed another multiple of front_interval (solver/ligament_events.h)
    through, // broken columns join the two features
};

/// One line of events.csv; when a history line saw it first, with that line's force and opening.
struct LigamentEvent
{
    std::int64_t step = 0;
    Real time = 0;             // ms
    Real force = 0, cod = 0;   // N, mm
    Real front = 0;            // 1, share of the ligament broken
    std::int32_t ligament = 0; // index into Problem::ligaments
    EventKind kind = EventKind::onset;
};

/// One line of history.csv; forces are means over the interval since the line before (of surface loads: of the moment),
/// full specimen.
struct HistoryLine
{
    std::int64_t step = 0;
    Real time = 0, dt = 0;                 // ms
    Real force_upper = 0, force_lower = 0; // N, positive: pulled apart
    Real cod = 0;                          // mm
    Ledger energy;                         // mJ, modelled part
    Real max_damage = 0;                   // 1
    std::uint64_t separated_particles = 0; // 1
    std::vector<std::uint64_t> particles;  // per level
};

/// Values of the case's measures at one time.
struct Sample
{
    std::int64_t step = 0;
    Real time = 0;           // ms
    std::vector<Real> value; // same order as Problem::quantities; NaN: not defined then
};

struct State
{
    particles::Particles particles;
    grid::Levels levels;
    Clock clock;
    transfer::Strays strays;
    transfer::Lattice lattice; // nodal scheme only: holds stress and plastic strain between outputs
    std::vector<LoadState> loads;
    std::vector<LigamentState> ligaments;
    std::vector<LigamentEvent> events;                   // every event so far
    std::vector<LeafWork> leaf_work;                     // [leaf]
    LeafWork folded_work;                                // mJ, of leaves that no longer exist
    Real initial_energy = 0;                             // mJ
    Real source_work = 0;                                // mJ, of body forces and surface loads
    Real damped_work = 0;                                // mJ, taken by damping (solver/damping.h)
    std::vector<Sample> samples;                         // of the measures, every one so far
    std::vector<HistoryLine> history;                    // every line so far: measures need peaks and events
    std::vector<std::uint32_t> gauge_upper, gauge_lower; // particle ids whose mean displacement is the gauge
    Real gauge_start = 0;                                // mm, difference of their displacements at time 0
    Real largest_opening = 0;                            // mm, of those looked at: outputs by opening are due once
};
} // namespace solver
