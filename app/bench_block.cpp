#include "app/bench_block.h"

#include "app/median.h"
#include "grid/walls.h"
#include "solver/nodal.h"
#include "solver/step.h"

#include <algorithm>
#include <array>
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
    problem.numerics.precision = scheme.precision;
    problem.numerics.basis = scheme.basis;
    return problem;
}

/// A smooth velocity field that makes the whole block flow.
std::array<Real, 3> stirring(const Vec3& x)
{
    return {5 * std::sin(0.3 * x[1]), 5 * std::sin(0.3 * x[2] + 1), 5 * std::sin(0.3 * x[0] + 2)};
}

void stir_particles(const solver::Prepared& prepared, solver::State& state)
{
    particles::Particles& particles = state.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const auto v = stirring({particles.position[0][p], particles.position[1][p], particles.position[2][p]});
        for (std::size_t a = 0; a < 3; ++a) particles.velocity[a][p] = v[a];
    }
    transfer::scatter(prepared.options, prepared.laws, state.strays, particles, state.levels);
}

void stir_nodes(solver::State& state)
{
    grid::Levels& levels = state.levels;
    for (std::size_t n = 0; n < levels.leaves.size(); ++n) {
        const grid::Leaf& leaf = levels.leaves[n];
        grid::for_owned_nodes([&](int node) {
            const Index3 local(node / (grid::tile_side * grid::tile_side), node / grid::tile_side % grid::tile_side,
                               node % grid::tile_side);
            const Vec3 x = levels.origin + levels.spacing(leaf.level) * (leaf.origin + local).cast<Real>();
            levels.motions(n)[node].velocity = stirring(x);
        });
    }
}
} // namespace

namespace
{
/// Nodes of a box, rows along z and planes of them: 2.5 nodes per axis on average when boxes lie anywhere.
constexpr double box_nodes = 15.6, box_rows = 6.25, box_planes = 2.5;

/// Gather and scatter of boxes work on lines of 8 numbers, whether all of them are wanted or not: operations per node,
/// row and plane in transfer/gimp_lines.h, a multiply-add is two. Weights take 90 each time; the law is that of points.
/// This is the count of the sums box by box; boxes that are read together (gimp_shared.h) take less.
double box_flops(const BenchCase& scheme)
{
    const auto walk = [](double node, double row, double plane) {
        return 8 * (node * box_nodes + row * box_rows + plane * box_planes);
    };
    const bool affine = scheme.transfer == solver::Transfer::apic,
               twice = scheme.stress_update != solver::StressUpdate::usl;
    const double slopes = walk(4, 4, 6), moments = walk(4, 6, 8) + 50, values = walk(2, 2, 2);
    const double gather = affine && !twice ? moments : slopes, give = affine ? walk(4, 4, 5) : walk(4, 4, 3);
    double flops = gather + give + 2 * 90 + 383;
    if (twice) flops += (affine ? moments + give : values + walk(2, 1, 1)) + 90;
    return flops;
}

/// Besides what points move: the layer of nodes around a leaf's tile, 602 nodes of 64 B, is read for motion, and
/// written and read for sums, each spread over 4096 particles.
constexpr double box_skin_bytes = 3 * 602 * 64 / 4096.0;

transfer::MachineLimits median_of(const std::vector<transfer::MachineLimits>& limits)
{
    std::vector<double> triad, fma;
    for (const transfer::MachineLimits& one : limits) {
        triad.push_back(one.triad_bytes_per_s);
        fma.push_back(one.fma_flops_per_s);
    }
    return {median(triad), median(fma)};
}

transfer::MachineLimits mean(const transfer::MachineLimits& a, const transfer::MachineLimits& b)
{
    return {(a.triad_bytes_per_s + b.triad_bytes_per_s) / 2, (a.fma_flops_per_s + b.fma_flops_per_s) / 2};
}

/// Particle-steps per second that either limit allows.
double roof(const BenchResult& result, const transfer::MachineLimits& limits)
{
    const double width = result.scheme.precision == solver::Precision::mixed ? 2 : 1; // lanes in single precision
    return std::min(limits.triad_bytes_per_s / result.bytes_per_particle_step,
                    width * limits.fma_flops_per_s / result.flops_per_particle_step);
}
} // namespace

double counted_flops(const BenchCase& scheme)
{
    if (scheme.transfer == solver::Transfer::nodal) return 533;
    double flops = scheme.formulation == solver::Formulation::total ? 913 : 733;
    if (scheme.stress_update == solver::StressUpdate::musl) flops += 270;
    if (scheme.transfer == solver::Transfer::apic) flops += 130;
    if (scheme.basis == solver::Basis::gimp) flops = box_flops(scheme);
    return flops;
}

double counted_bytes(const BenchCase& scheme)
{
    const double node = 46; // sums and motions of the tiles, spread over 8 particles per cell
    if (scheme.transfer == solver::Transfer::nodal) {
        const double tiles = 57; // motion and force, spread over 8 particles per cell
        return scheme.precision == solver::Precision::mixed ? 60 + tiles : 120 + tiles;
    }
    const double skin = scheme.basis == solver::Basis::gimp ? box_skin_bytes : 0;
    double bytes = (scheme.formulation == solver::Formulation::total ? 397 : 246) + node + skin;
    // The pass before: position, velocity and mass to the grid; the velocity is written there, not in the main pass.
    if (scheme.stress_update == solver::StressUpdate::musl) bytes += 56 + node + skin;
    if (scheme.transfer == solver::Transfer::apic) bytes += 144;
    return bytes;
}

BenchResult bench_block(const BenchCase& scheme, int cells, int steps, int threads)
{
    const solver::Problem problem = block(scheme, cells);
    const solver::Prepared prepared = solver::prepare(problem);
    solver::Derived derived;
    solver::State state = solver::initialise(problem, prepared, derived);
    if (solver::nodal(problem))
        stir_nodes(state);
    else
        stir_particles(prepared, state);

    BenchResult result;
    result.scheme = scheme;
    result.threads = threads;
    result.particles = state.particles.size();
    result.bytes_per_particle_step = counted_bytes(scheme);
    result.flops_per_particle_step = counted_flops(scheme);

    constexpr int rounds = 5;
    std::vector<double> rates, shares;
    std::vector<transfer::MachineLimits> limits{transfer::measure_limits(threads)};
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> here;
        for (int n = round; n < std::max(steps, rounds); n += rounds) {
            const auto start = std::chrono::steady_clock::now();
            solver::advance(problem, prepared, state, derived);
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
            here.push_back(static_cast<double>(result.particles) / spent.count());
        }
        limits.push_back(transfer::measure_limits(threads));
        shares.push_back(median(here) / roof(result, mean(limits.end()[-2], limits.back())));
        rates.insert(rates.end(), here.begin(), here.end());
    }
    result.particle_steps_per_s = median(rates);
    result.roof_share = median(shares);
    result.limits = median_of(limits);
    return result;
}
} // namespace app
