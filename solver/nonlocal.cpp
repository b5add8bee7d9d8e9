#include "solver/nonlocal.h"

namespace solver
{
void start_nonlocal_cracks(const transfer::PassOptions& options, const Prepared& prepared, State& state,
                           transfer::NonlocalTable& table)
{
    if (prepared.laws.nonlocal_radius <= 0) return;
    if (state.clock.step % transfer::nonlocal_interval(prepared.laws, options.dt) != 0) return;
    const std::size_t started =
        transfer::start_nonlocal_cracks(options, prepared.laws, state.levels, state.lattice, state.particles, table);
    // A cracked particle leaves its cell's mean pressure: the sums, made while it was intact, are out of date.
    if (started > 0 && options.formulation == Formulation::updated)
        transfer::scatter(options, prepared.laws, state.strays, state.particles, state.levels);
}
} // namespace solver
