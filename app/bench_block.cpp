#include "app/bench_block.h"

#include "solver/step.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace app
{
namespace
{
solver::Problem block(const BenchCase& scheme, int cells)
{
    solver::Problem problem;
    problem.grid.cell = 1;
    problem.grid.levels = scheme.levels;
    material::Material m;
    m.name = "metal";
    m.elastic = {1e-3, 1000, 0.3};
    m.plastic = material::VonMises{0.5, 50};
    problem.materials = {m};
    const Vec3 lower = Vec3::Constant(3); // not a multiple of the leaf side
    solver::Body body;
    body.name = "block";
    body.shape = geometry::box(lower, lower + Vec3::Constant(cells));
    problem.bodies = {body};
    if (scheme.levels > 1)
        problem.zones = {{"corner", geometry::box(lower, lower + Vec3::Constant(cells / 2.0)), scheme.levels - 1, 0}};
    problem.symmetry = {{2, 3.0}};
    problem.gravity = Vec3(0, 0, -40);
    problem.numerics.formulation = scheme.formulation;
    problem.numerics.stress_update = scheme.stress_update;
    problem.numerics.transfer = scheme.transfer;
    return problem;
}

/// A smooth velocity field that makes the whole block flow.
void stir(particles::Particles& particles)
{
    for (std::size_t p = 0; p < particles.size(); ++p)
        for (std::size_t a = 0; a < 3; ++a)
            particles.velocity[a][p] = 5 * std::sin(0.3 * particles.position[(a + 1) % 3][p] + static_cast<Real>(a));
}
} // namespace

double counted_flops(const BenchCase& scheme)
{
    double flops = scheme.formulation == solver::Formulation::total ? 880 : 700;
    if (scheme.stress_update == solver::StressUpdate::musl) flops += 270;
    if (scheme.transfer == solver::Transfer::apic) flops += 130;
    return flops;
}

double counted_bytes(const BenchCase& scheme)
{
    const double node = 46; // sums and motions of the tiles, spread over 8 particles per cell
    double bytes = (scheme.formulation == solver::Formulation::total ? 397 : 246) + node;
    if (scheme.stress_update == solver::StressUpdate::musl) bytes += 104 + node;
    if (scheme.transfer == solver::Transfer::apic) bytes += 144;
    return bytes;
}

BenchResult bench_block(const BenchCase& scheme, int cells, int steps)
{
    const solver::Problem problem = block(scheme, cells);
    const solver::Prepared prepared = solver::prepare(problem);
    solver::Derived derived;
    solver::State state = solver::initialise(problem, prepared, derived);
    stir(state.particles);
    transfer::scatter(prepared.options, prepared.laws, state.strays, state.particles, state.levels);
    std::vector<double> seconds;
    for (int n = 0; n < steps; ++n) {
        const auto start = std::chrono::steady_clock::now();
        solver::advance(problem, prepared, state, derived);
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(seconds.begin(), seconds.end());
    BenchResult result;
    result.scheme = scheme;
    result.particles = state.particles.size();
    result.particle_steps_per_s = static_cast<double>(result.particles) / seconds[seconds.size() / 2];
    result.bytes_per_particle_step = counted_bytes(scheme);
    result.flops_per_particle_step = counted_flops(scheme);
    return result;
}
} // namespace app
