#include "transfer/machine_limits.h"

#include "core/simd.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace transfer
{
namespace
{
using Lanes = core::Pack<Real, core::native_lanes<Real>>;

/// Least time of several trials of `work(part)` on one thread per part. Plain threads: a task scheduler may give two
/// short parts to the same one.
template <class Work>
double best_seconds(int trials, std::size_t parts, const Work& work)
{
    double best = 1e30;
    for (int t = 0; t < trials; ++t) {
        const auto start = std::chrono::steady_clock::now();
        std::vector<std::thread> threads;
        for (std::size_t part = 0; part < parts; ++part) threads.emplace_back([&work, part] { work(part); });
        for (std::thread& thread : threads) thread.join();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// Multiply-adds in ten dependent chains, enough to hide their latency; single variables, because the compiler keeps an
/// array of them in memory.
constexpr int chains = 10;
Real spin(long rounds, Real seed)
{
    const Lanes a(Real(0.999999)), b(Real(1e-7));
    Lanes c0(seed), c1(seed + 1), c2(seed + 2), c3(seed + 3), c4(seed + 4), c5(seed + 5), c6(seed + 6), c7(seed + 7),
        c8(seed + 8), c9(seed + 9);
    for (long r = 0; r < rounds; ++r) {
        c0 = c0 * a + b;
        c1 = c1 * a + b;
        c2 = c2 * a + b;
        c3 = c3 * a + b;
        c4 = c4 * a + b;
        c5 = c5 * a + b;
        c6 = c6 * a + b;
        c7 = c7 * a + b;
        c8 = c8 * a + b;
        c9 = c9 * a + b;
    }
    return core::sum(c0 + c1 + c2 + c3 + c4 + c5 + c6 + c7 + c8 + c9);
}
} // namespace

MachineLimits measure_limits(int threads)
{
    MachineLimits limits;
    const auto parts = static_cast<std::size_t>(threads);

    constexpr std::size_t length = 8'000'000;
    std::vector<Real> a(length, 1), b(length, 2), c(length, 3);
    const double triad = best_seconds(6, parts, [&](std::size_t part) {
        const std::size_t begin = length / parts * part;
        const std::size_t end = part + 1 == parts ? length : length / parts * (part + 1);
        for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + Real(0.5) * c[i];
    });
    limits.triad_bytes_per_s = 3 * sizeof(Real) * static_cast<Real>(length) / triad;

    constexpr long rounds = 4'000'000;
    std::vector<Real> sink(parts * 64);
    const double fma = best_seconds(6, parts, [&](std::size_t part) { sink[part * 64] = spin(rounds, a[part]); });
    limits.fma_flops_per_s =
        Real(2) * chains * Lanes::lanes * static_cast<Real>(rounds) * static_cast<Real>(parts) / fma;
    return limits;
}
} // namespace transfer
