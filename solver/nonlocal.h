/// The nonlocal onset as a phase of the step: when it is due, and what follows from it.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"
#include "transfer/nonlocal_onset.h"

namespace solver
{
/// After the stress update and before the clock ticks: test the onset of materials with a nonlocal radius, every
/// transfer::nonlocal_interval steps counted from the beginning of the run.
void start_nonlocal_cracks(const transfer::PassOptions& options, const Prepared& prepared, State& state,
                           transfer::NonlocalTable& table);
} // namespace solver
