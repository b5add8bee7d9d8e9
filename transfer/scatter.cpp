#include "transfer/passes.h"

#include "core/parallel.h"
#include "grid/hanging.h"
#include "transfer/gimp_passes.h"
#include "transfer/interface_affine.h"
#include "transfer/scatter_leaf.h"

namespace transfer
{
void scatter(const PassOptions& options, const LawTable& laws, Strays& strays, const particles::Particles& particles,
             grid::Levels& levels)
{
    if (options.transfer == Transfer::apic) grid::keep_affine(levels);
    if (uses_boxes(options)) return scatter_boxes(options, laws, strays, particles, levels);
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        scatter_leaf(options, laws, particles, n, levels);
        scatter_affine(options, particles, n, levels);
    });
    scatter_strays(options, laws, strays, particles, levels);
    scatter_stray_affine(options, strays, particles, levels);
}
} // namespace transfer
