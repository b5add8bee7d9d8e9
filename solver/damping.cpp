#include "solver/damping.h"

#include "grid/damping.h"
#include "solver/loads.h"

namespace solver
{
namespace
{
/// What `damping` would take of components that loads hold [mJ].
Real held_energy(const Problem& problem, const std::vector<LoadNodes>& nodes, const grid::Damping& damping,
                 const grid::Levels& levels)
{
    Real sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t n = 0; n < nodes[i].node.size(); ++n) {
            const std::array<Real, 3> energy = grid::damped_energy(damping, nodes[i].node[n], levels);
            for (int a = 0; a < 3; ++a)
                if (holds(problem.loads[i], a) && (nodes[i].before[n] >> a & 1) == 0)
                    sum += energy[static_cast<std::size_t>(a)];
        }
    return sum;
}
} // namespace

void damp_nodes(const Problem& problem, const Derived& derived, State& state)
{
    const Numerics& numerics = problem.numerics;
    if (numerics.damping == 0) return;
    const grid::Damping damping{numerics.damping, numerics.damping_memory, state.clock.dt, problem.gravity};
    state.damped_work -= held_energy(problem, derived.load_nodes, damping, state.levels);
    state.damped_work += grid::damp_motion(damping, state.levels);
}
} // namespace solver
