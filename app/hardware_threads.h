/// Threads that the machine runs at a time.
#pragma once

#include <algorithm>
#include <thread>

namespace app
{
/// At least 1: some systems do not tell.
inline int hardware_threads()
{
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}
} // namespace app
