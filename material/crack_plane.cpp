#include "material/crack_plane.h"

#include <algorithm>
#include <cmath>

namespace material
{
namespace
{
using Vec = core::Vec<double>;

double length(const Vec& a)
{
    return std::sqrt(core::dot(a, a));
}
Vec unit(const Vec& a)
{
    return (1 / length(a)) * a;
}

/// The ranking of the header: true when b is strictly better than a.
bool better(const Vec& b, const Vec& a, const Bias& bias)
{
    const double rate_a = length(bias.velocity_gradient * a), rate_b = length(bias.velocity_gradient * b);
    if (std::abs(rate_a - rate_b) > equal_rate_tolerance * std::max(rate_a, rate_b)) return rate_b > rate_a;
    const double near_a = std::abs(core::dot(bias.preferred_normal, a));
    const double near_b = std::abs(core::dot(bias.preferred_normal, b));
    return near_b > near_a + equal_rate_tolerance;
}

/// Direction of the space spanned by the orthonormal `basis` along which the velocity changes most: the eigenvector of
/// L^T L in that space. Where that is not unique either, the preferred normal's projection; else the first of the
/// basis.
template <std::size_t Dimension>
Vec fastest_direction(const std::array<Vec, Dimension>& basis, const Bias& bias)
{
    constexpr int dimension = static_cast<int>(Dimension);
    core::Sym<double> metric{};
    for (int i = 0; i < dimension; ++i)
        for (int j = i; j < dimension; ++j)
            metric[core::Sym<double>::at(i, j)] =
                core::dot(bias.velocity_gradient * basis[static_cast<std::size_t>(i)],
                          bias.velocity_gradient * basis[static_cast<std::size_t>(j)]);
    const Principal rate = principal(metric); // squared rates: their relative difference is twice that of the rates
    if (rate.value[0] - rate.value[1] > 2 * equal_rate_tolerance * rate.value[0]) {
        Vec fastest{};
        for (int i = 0; i < dimension; ++i)
            fastest = fastest + rate.direction[0][i] * basis[static_cast<std::size_t>(i)];
        return with_fixed_sign(fastest);
    }
    Vec projection{};
    for (const Vec& direction : basis)
        projection = projection + core::dot(bias.preferred_normal, direction) * direction;
    if (length(projection) > equal_rate_tolerance) return with_fixed_sign(unit(projection));
    return basis[0];
}

/// Replace directions that the stress leaves open by the ones the motion prefers; n_1 and n_3 span every plane's
/// normal.
Principal oriented(const Principal& stress, const Bias& bias)
{
    const std::array<double, 3>& s = stress.value;
    const double tolerance = equal_stress_tolerance * std::max(std::abs(s[0]), std::abs(s[2]));
    const bool equal_12 = s[0] - s[1] <= tolerance, equal_23 = s[1] - s[2] <= tolerance;
    if (!equal_12 && !equal_23) return stress;

    Principal result = stress;
    auto& n = result.direction;
    if (equal_12 && equal_23)
        n[0] = fastest_direction<3>(n, bias);
    else if (equal_12)
        n[0] = fastest_direction<2>({n[0], n[1]}, bias);
    else
        n[2] = fastest_direction<2>({n[2], n[1]}, bias);

    if (equal_12 && equal_23) { // any right-handed completion: only opening can start without shear
        const Vec other = std::abs(n[0][0]) < 0.8 ? Vec{{1, 0, 0}} : Vec{{0, 1, 0}};
        n[1] = unit(core::cross(n[0], other));
        n[2] = core::cross(n[0], n[1]);
    } else {
        n[1] = core::cross(n[2], n[0]);
    }
    return result;
}
} // namespace

core::Vec<double> crack_normal(Mode mode, const Principal& stress, const Bias& bias)
{
    const Principal frame = oriented(stress, bias);
    const Vec& first = frame.direction[0];
    const Vec& third = frame.direction[2];
    if (mode == Mode::opening) return first;

    const auto candidate = [&](double sign) {
        const Vec shear = unit(first + sign * third);
        return mode == Mode::shear ? shear : unit(first + shear);
    };
    const Vec paper = candidate(-1), conjugate = candidate(1);
    return better(conjugate, paper, bias) ? conjugate : paper;
}
} // namespace material
