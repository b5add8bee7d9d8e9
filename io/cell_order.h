/// The order cells are listed in: by x, then y, then z, as everywhere z runs fastest.
#pragma once

#include "core/real.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>

namespace io
{
/// What cells are ordered by.
inline std::tuple<int, int, int> cell_key(const Index3& cell)
{
    return {cell.x(), cell.y(), cell.z()};
}

/// Number of the first cell in an ordered list that does not come before `cell`: of the cell itself if it is there.
inline std::size_t find_cell(std::span<const Index3> cells, const Index3& cell)
{
    const auto found = std::lower_bound(cells.begin(), cells.end(), cell,
                                        [](const Index3& a, const Index3& b) { return cell_key(a) < cell_key(b); });
    return static_cast<std::size_t>(found - cells.begin());
}
} // namespace io
