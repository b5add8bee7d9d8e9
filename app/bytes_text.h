/// Bytes as people write them.
#pragma once

#include "core/real.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <string_view>

namespace app
{
/// Three digits and a unit of a power of 1000: "1.23 GB".
inline std::string bytes_text(Real bytes)
{
    constexpr std::string_view names[] = {"B", "kB", "MB", "GB", "TB"};
    std::size_t n = 0;
    while (bytes >= 1000 && n + 1 < std::size(names)) bytes /= 1000, ++n;
    return fmt::format("{:.3g} {}", bytes, names[n]);
}
} // namespace app
