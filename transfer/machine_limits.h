/// What this machine can do at most, measured with the instruction set of the kernels: the roofs `cleave bench` quotes.
#pragma once

#include "core/real.h"

namespace transfer
{
struct MachineLimits
{
    Real triad_bytes_per_s = 0; // byte/s, a = b + s c over arrays far larger than the caches, three streams counted
    Real fma_flops_per_s = 0;   // 1/s, independent fused multiply-adds in registers, two flops each
};

/// Best of several short trials on `threads` threads; about half a second.
MachineLimits measure_limits(int threads);
} // namespace transfer
