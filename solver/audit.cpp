#include "solver/audit.h"

#include "core/parallel.h"
#include "grid/walls.h"
#include "material/elastic.h"
#include "particles/tensors.h"
#include "transfer/solid_share.h"

namespace solver
{
namespace
{
Real volume(const particles::Particles& particles, Formulation formulation, std::size_t p)
{
    Real v = particles.rest_volume[p];
    if (formulation == Formulation::total) {
        v *= core::determinant(particles::deformation_of(particles, p));
    } else {
        v *= particles.volume_ratio[p];
    }
    const std::int32_t crack = particles.crack[p];
    return crack < 0 ? v : v * transfer::solid_share(particles.cracks[static_cast<std::size_t>(crack)]);
}

/// Kinetic and elastic energy and the work of gravity, leaf by leaf, from nodes that carry the motion.
std::vector<Ledger> audit_nodes(const Prepared& prepared, const State& state)
{
    const grid::Levels& levels = state.levels;
    std::vector<Ledger> leaf(levels.leaves.size());
    std::vector<transfer::LatticeSurvey> survey;
    transfer::survey_lattice(prepared.laws, state.lattice, state.particles, levels, survey);
    core::parallel_for(leaf.size(), [&](std::size_t n) {
        leaf[n].elastic = survey[n].elastic;
        grid::for_owned_nodes([&](int node) {
            const Real mass = levels.forces(n)[node].mass();
            const grid::NodeMotion& motion = levels.motions(n)[node];
            for (std::size_t a = 0; a < 3; ++a) {
                leaf[n].kinetic += mass * motion.velocity[a] * motion.velocity[a] / 2;
                leaf[n].external += mass * prepared.gravity[static_cast<int>(a)] * motion.change[a];
            }
        });
    });
    return leaf;
}

std::vector<Ledger> audit_particles(const Prepared& prepared, const State& state)
{
    const particles::Particles& particles = state.particles;
    const grid::Levels& levels = state.levels;
    std::vector<Ledger> leaf(levels.leaves.size());
    core::parallel_for(leaf.size(), [&](std::size_t n) {
        for (std::uint32_t p = levels.cell_start[n * grid::leaf_cells];
             p < levels.cell_start[(n + 1) * grid::leaf_cells]; ++p) {
            Real speed2 = 0;
            for (const particles::Column& v : particles.velocity) speed2 += v[p] * v[p];
            leaf[n].kinetic += particles.mass[p] * speed2 / 2;
            for (std::size_t a = 0; a < 3; ++a)
                leaf[n].external += particles.mass[p] * prepared.gravity[static_cast<int>(a)] *
                                    (particles.position[a][p] - particles.rest_position[a][p]);
            leaf[n].elastic += volume(particles, prepared.options.formulation, p) *
                               material::elastic_energy(prepared.laws.materials[particles.material[p]].elastic,
                                                        particles::stress_of(particles, p));
        }
    });
    return leaf;
}
} // namespace

Ledger audit(const Prepared& prepared, const State& state)
{
    const bool nodal = prepared.options.transfer == Transfer::nodal;
    const std::vector<Ledger> leaf = nodal ? audit_nodes(prepared, state) : audit_particles(prepared, state);
    Ledger total;
    total.plastic = state.folded_work.plastic;
    total.decohesion = state.folded_work.decohesion;
    for (std::size_t n = 0; n < leaf.size(); ++n) {
        total.kinetic += leaf[n].kinetic;
        total.elastic += leaf[n].elastic;
        total.external += leaf[n].external;
        total.plastic += state.leaf_work[n].plastic;
        total.decohesion += state.leaf_work[n].decohesion;
    }
    for (const LoadState& load : state.loads) total.external += load.external_work;
    total.external += state.source_work;
    total.damping = state.damped_work;
    total.initial = state.initial_energy;
    return total;
}

Vec3 momentum(const particles::Particles& particles)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < particles.size(); ++p)
        for (std::size_t a = 0; a < 3; ++a) sum[static_cast<int>(a)] += particles.mass[p] * particles.velocity[a][p];
    return sum;
}
} // namespace solver
