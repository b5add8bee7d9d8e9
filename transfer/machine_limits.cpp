#include "transfer/machine_limits.h"

#include "core/parallel.h"
#include "core/simd.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace transfer
{
namespace
{
using Lanes = core::Pack<Real, core::native_lanes<Real>>;

template <class Work>
double best_seconds(int trials, const Work& work)
{
    double best = 1e30;
    for (int t = 0; t < trials; ++t) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// Multiply-adds in a dependent chain per register; enough registers to hide the latency.
Real spin(long rounds, Real seed)
{
    constexpr int chains = 12;
    Lanes x[chains];
    for (int c = 0; c < chains; ++c) x[c] = Lanes(seed + c);
    const Lanes a(Real(0.999999)), b(Real(1e-7));
    for (long r = 0; r < rounds; ++r)
        for (int c = 0; c < chains; ++c) x[c] = x[c] * a + b;
    Real s = 0;
    for (int c = 0; c < chains; ++c) s += core::sum(x[c]);
    return s;
}
} // namespace

MachineLimits measure_limits(int threads)
{
    MachineLimits limits;
    const auto parts = static_cast<std::size_t>(threads);

    constexpr std::size_t length = 8'000'000;
    std::vector<Real> a(length, 1), b(length, 2), c(length, 3);
    const double triad = best_seconds(5, [&] {
        core::parallel_for(parts, [&](std::size_t part) {
            const std::size_t begin = length / parts * part;
            const std::size_t end = part + 1 == parts ? length : length / parts * (part + 1);
            for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + Real(0.5) * c[i];
        });
    });
    limits.triad_bytes_per_s = 3 * sizeof(Real) * static_cast<Real>(length) / triad;

    constexpr long rounds = 4'000'000;
    std::vector<Real> sink(parts * 64);
    const double fma = best_seconds(
        4, [&] { core::parallel_for(parts, [&](std::size_t part) { sink[part * 64] = spin(rounds, a[part]); }); });
    limits.fma_flops_per_s = Real(2) * 12 * Lanes::lanes * static_cast<Real>(rounds) * static_cast<Real>(parts) / fma;
    return limits;
}
} // namespace transfer
