#include "solver/nodal.h"

#include "core/error.h"
#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/nodal.h"

namespace solver
{
namespace
{
void enter_lattice(const Prepared& prepared, State& state)
{
    if (!transfer::enter_lattice(prepared.options.precision, state.levels, state.particles, state.lattice))
        throw core::InputError(
            "numerics.transfer = \"nodal\" needs one particle on each of the eight lattice points of a "
            "cell, but two bodies share the points of a cell. Use transfer = \"flip\", or let the "
            "bodies meet on a node plane.");
}
} // namespace

void start_nodal(const Prepared& prepared, State& state)
{
    grid::start_nodes(prepared.walls, prepared.mass_cutoff, state.levels);
    grid::prolong_motion(state.levels);
    grid::fill_motion_halos(state.levels);
    enter_lattice(prepared, state);
}

void resume_nodal(const Prepared& prepared, State& state)
{
    transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
    grid::restore_masses(prepared.mass_cutoff, state.levels);
    enter_lattice(prepared, state);
}

OutputColumns::OutputColumns(State& state) : state_(state)
{
    if (state_.lattice.in_use()) transfer::fill_columns(state_.levels, state_.lattice, state_.particles);
}

OutputColumns::~OutputColumns()
{
    if (state_.lattice.in_use()) transfer::drop_columns(state_.particles);
}
} // namespace solver
