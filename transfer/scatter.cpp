#include "transfer/passes.h"

#include "core/parallel.h"
#include "transfer/scatter_leaf.h"

namespace transfer
{
void scatter(const PassOptions& options, const LawTable& laws, const Strays& strays,
             const particles::Particles& particles, grid::Levels& levels)
{
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) { scatter_leaf(options, laws, particles, n, levels); });
    scatter_strays(options, laws, strays, particles, levels);
}
} // namespace transfer
