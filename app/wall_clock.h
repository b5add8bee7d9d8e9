/// Time that goes by on the wall, for progress and records.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string>

namespace app
{
inline double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// 5025 as "1:23:45".
inline std::string clock_time(double seconds)
{
    const long s = std::lround(seconds);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}
} // namespace app
