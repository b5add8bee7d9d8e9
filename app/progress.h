/// The status line of a run: step, time, dt, force, opening, energies, particles, speed, time left, memory.
///
/// `step 41 200/98 000  t 0.504 ms (42 %)  dt 1.22e-5  F 7.91 kN  COD 2.31 mm  KE/IE 0.3 %  L0 1.1M L1 2.4M  38 Mp/s
///  ETA 0:47:10  RSS 2.9 GB`: in place on a terminal, a plain line every 30 s elsewhere and in log.txt.
#pragma once

#include "app/log.h"
#include "solver/problem.h"
#include "solver/state.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace app
{
/// What one status line shows. Empty: not known, left out.
struct Status
{
    solver::Clock clock;
    solver::HistoryLine last;         // newest line of the history
    std::optional<Real> done;         // 1, share of the run behind us
    std::optional<Real> seconds_left; // s
    Real particle_steps_per_s = 0;    // 1/s, since the line before
    std::uint64_t resident_bytes = 0; // byte
};

std::string status_line(const Status& status);

/// Share of the run that is done, by time or by opening, whichever ends it first; empty if neither has an end.
std::optional<Real> share_done(const solver::End& end, Real time, Real cod);

/// Decides when to show a status line and works out speed and time left.
class Progress
{
public:
    /// @param seconds  a clock that never goes back
    Progress(const solver::End& end, Log& log, std::function<double()> seconds);
    /// The same with the clock of the system.
    Progress(const solver::End& end, Log& log);

    /// Call after every step; does nothing when no line is due.
    void after_step(const solver::Clock& clock, const solver::HistoryLine& last, std::uint64_t updates);

private:
    solver::End end_;
    Log* log_;
    std::function<double()> seconds_;
    double start_;                      // s, first call
    std::optional<Real> done_at_start_; // 1, of a resumed run
    bool started_ = false;
    double shown_, plain_;             // s, when the last line of either kind was due
    std::uint64_t particle_steps_ = 0; // 1, since the last line
};
} // namespace app
