/// The State inside a checkpoint file, one group per member: what is stored and how, but not which file or case.
#pragma once

#include "io/hdf5.h"
#include "solver/state.h"

namespace io
{
/// Store all that a bitwise continuation needs.
/// @error FileError
void store_state(const solver::State& state, Hdf5Writer& file);

/// Read what store_state wrote and check that sizes and indices fit together.
/// @error FileError
solver::State load_state(const Hdf5Reader& file);
} // namespace io
