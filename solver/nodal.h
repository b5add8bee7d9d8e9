/// The nodal scheme (transfer/lattice.h) as the solver sees it: its beginning and its particles for output.
#pragma once

#include "solver/prepared.h"
#include "solver/state.h"

namespace solver
{
/// Whether the nodes carry the motion.
inline bool nodal(const Problem& problem)
{
    return problem.numerics.transfer == Transfer::nodal;
}

/// Give mass and velocity to the nodes, stress to the lattice.
/// @pre   sums as scattered, halos not assembled
/// @error core::InputError if the particles do not sit on the lattice
void start_nodal(const Prepared& prepared, State& state);

/// Rebuild what a checkpoint does not hold; `state` has all columns, and motion and force tiles as they were.
void resume_nodal(const Prepared& prepared, State& state);

/// While it lives, particles have every column, whatever the scheme: for output.
class OutputColumns
{
public:
    explicit OutputColumns(State& state);
    ~OutputColumns();
    OutputColumns(const OutputColumns&) = delete;
    OutputColumns& operator=(const OutputColumns&) = delete;

private:
    State& state_;
};
} // namespace solver
