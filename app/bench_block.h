/// The block every throughput number refers to: N^3 cells of 8 particles, plastic, one symmetry plane, gravity.
///
/// Not aligned to leaves, more than 90 % of the particles yield from the first steps on, so the plastic path is used.
#pragma once

#include "solver/problem.h"
#include "transfer/machine_limits.h"

namespace app
{
struct BenchCase
{
    solver::Formulation formulation = solver::Formulation::total;
    solver::StressUpdate stress_update = solver::StressUpdate::usl;
    solver::Transfer transfer = solver::Transfer::flip;
    solver::Precision precision = solver::Precision::f64;
    int levels = 1; // 2: an eighth of the block is refined
    solver::Basis basis = solver::Basis::trilinear;
};

struct BenchResult
{
    BenchCase scheme;
    int threads = 1;
    std::size_t particles = 0;
    transfer::MachineLimits limits;  // median of those measured between the steps
    double particle_steps_per_s = 0; // median over steps of the whole step
    double bytes_per_particle_step = 0;
    double flops_per_particle_step = 0;
    double roof_share = 0; // rate over the lower of bandwidth / bytes and FMA rate / flops, median over rounds
};

/// Flops and bytes a particle costs per step: counted by hand in the kernels (docs/performance.md).
double counted_flops(const BenchCase& scheme);
double counted_bytes(const BenchCase& scheme);

/// Run `steps` steps of a block of `cells`^3 cells on `threads` threads, to which the caller has limited the program.
///
/// The steps are taken in five rounds with the machine's limits measured before, between and after them, and a round is
/// held against the mean of the two beside it: on a machine with other tenants rate and limits drift together.
BenchResult bench_block(const BenchCase& scheme, int cells, int steps, int threads);
} // namespace app
