/// Values of a measure at many times to one number.
#include "solver/sample.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace solver
{
namespace
{
constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();

struct Series
{
    std::vector<Real> time, value; // finite values only
};

Series series_of(const std::vector<Sample>& samples, std::size_t index, const Reduction& reduction)
{
    Series series;
    // The tolerance keeps a clock that sums steps from missing the ends by its last bit.
    const Real slack = samples.empty() ? 0 : 1e-9 * samples.back().time;
    for (const Sample& sample : samples) {
        if (reduction.from && sample.time < *reduction.from - slack) continue;
        if (reduction.until && sample.time > *reduction.until + slack) continue;
        if (!std::isfinite(sample.value[index])) continue;
        series.time.push_back(sample.time);
        series.value.push_back(sample.value[index]);
    }
    return series;
}

Real value_at(const Series& series, Real time)
{
    const auto after = std::lower_bound(series.time.begin(), series.time.end(), time);
    if (after == series.time.end()) // the clock may stop a rounding before
        return !series.time.empty() && time <= series.time.back() * (1 + 1e-9) ? series.value.back() : nothing;
    const auto n = static_cast<std::size_t>(after - series.time.begin());
    if (n == 0) return *after <= time * (1 + 1e-9) + 1e-300 ? series.value[0] : nothing;
    const Real share = (time - series.time[n - 1]) / (series.time[n] - series.time[n - 1]);
    return series.value[n - 1] + share * (series.value[n] - series.value[n - 1]);
}

/// Mean over time, trapezoidal rule.
Real mean_of(const Series& series)
{
    Real sum = 0;
    for (std::size_t n = 1; n < series.time.size(); ++n)
        sum += (series.time[n] - series.time[n - 1]) * (series.value[n] + series.value[n - 1]) / 2;
    const Real length = series.time.back() - series.time.front();
    return length > 0 ? sum / length : series.value.back();
}

Real period_of(const Series& series)
{
    const Real mean = mean_of(series);
    Real first = 0, last = 0;
    int count = 0;
    for (std::size_t n = 1; n < series.time.size(); ++n) {
        const Real before = series.value[n - 1] - mean, after = series.value[n] - mean;
        if (before >= 0 || after < 0) continue;
        last = series.time[n] - (series.time[n] - series.time[n - 1]) * after / (after - before);
        if (count++ == 0) first = last;
    }
    return count > 1 ? (last - first) / (count - 1) : nothing;
}

/// 2 / T |integral of s exp(-i omega t)|, the amplitude of a sine of that frequency.
Real fourier_of(const Series& series, Real frequency)
{
    const auto term = [&](std::size_t n) {
        return series.value[n] * std::polar(Real(1), -2 * std::numbers::pi * frequency * series.time[n]);
    };
    std::complex<Real> sum = 0;
    for (std::size_t n = 1; n < series.time.size(); ++n)
        sum += (series.time[n] - series.time[n - 1]) * (term(n) + term(n - 1)) / Real(2);
    const Real length = series.time.back() - series.time.front();
    return length > 0 ? 2 * std::abs(sum) / length : nothing;
}

/// @param scale_of  of the measure that `when_max` and `when_min` look at
Real reduced(const Quantity& quantity, std::size_t index, Real scale_of, const std::vector<Sample>& samples)
{
    using enum Reduction::At;
    const Reduction& reduction = quantity.reduction;
    const Series series = series_of(samples, index, reduction);
    if (series.time.empty()) return nothing;
    if (reduction.time) return value_at(series, *reduction.time);
    const auto [least, largest] = std::minmax_element(series.value.begin(), series.value.end());
    switch (reduction.at) {
    case end:
        return series.value.back();
    case max:
        return quantity.scale < 0 ? *least : *largest; // of the results, which are scaled
    case min:
        return quantity.scale < 0 ? *largest : *least;
    case mean:
        return mean_of(series);
    case amplitude:
        return (*largest - *least) / 2;
    case period:
        return period_of(series);
    case fourier:
        return fourier_of(series, reduction.frequency);
    case when_max:
    case when_min:
        break;
    }
    const Series other = series_of(samples, reduction.of, reduction);
    if (other.time.empty()) return nothing;
    const auto [low, high] = std::minmax_element(other.value.begin(), other.value.end());
    const bool falls = scale_of < 0; // the largest result is then the least value
    const auto chosen = (reduction.at == when_max) != falls ? high : low;
    return value_at(series, other.time[static_cast<std::size_t>(chosen - other.value.begin())]);
}
} // namespace

std::vector<Real> results(const std::vector<Quantity>& quantities, const std::vector<Sample>& samples)
{
    std::vector<Real> result(quantities.size(), nothing);
    for (std::size_t i = 0; i < quantities.size(); ++i)
        if (!std::holds_alternative<Ratio>(quantities[i].kind))
            result[i] =
                quantities[i].scale * reduced(quantities[i], i, quantities[quantities[i].reduction.of].scale, samples);
    for (std::size_t i = 0; i < quantities.size(); ++i)
        if (const auto* ratio = std::get_if<Ratio>(&quantities[i].kind))
            result[i] = quantities[i].scale * result[ratio->of] / result[ratio->over];
    return result;
}

Real relative_error(Real value, Real reference)
{
    return reference == 0 ? value : value / reference - 1;
}
} // namespace solver
