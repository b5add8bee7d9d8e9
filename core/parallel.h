/// Parallel loops over independent items. Whoever owns the destination writes it, so the result never depends on
/// the number of threads or on the schedule; sums over items are formed afterwards in item order.
#pragma once

#include "core/real.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

namespace core
{
/// Call `body(i)` for every i in [0, count), several at a time. `body` may write only what item i owns.
template <class Body>
void parallel_for(std::size_t count, const Body& body)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
    });
}

/// Sum of `value(i)`, formed in the order of i.
template <class Value>
Real parallel_sum(std::size_t count, const Value& value)
{
    std::vector<Real> part(count, 0);
    parallel_for(count, [&](std::size_t i) { part[i] = value(i); });
    Real sum = 0;
    for (const Real one : part) sum += one;
    return sum;
}
} // namespace core
