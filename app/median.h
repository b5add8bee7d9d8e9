/// Median of measured numbers.
#pragma once

#include "core/contract.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace app
{
/// The upper median, element n / 2 in order, of at least one number.
inline double median(std::vector<double> values)
{
    CLEAVE_EXPECTS(!values.empty());
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}
} // namespace app
