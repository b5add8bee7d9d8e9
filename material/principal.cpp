#include "material/principal.h"

#include "core/contract.h"

#include <cmath>
#include <utility>

namespace material
{
namespace
{
/// One Jacobi rotation in the plane (i, j): zeroes a(i, j) and gathers the rotation in the columns of v.
void rotate(core::Mat<double>& a, core::Mat<double>& v, int i, int j)
{
    if (a(i, j) == 0) return;
    const double theta = (a(j, j) - a(i, i)) / (2 * a(i, j));
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
    const double c = 1 / std::sqrt(1 + t * t), s = t * c;
    const int k = 3 - i - j;
    a(i, i) -= t * a(i, j);
    a(j, j) += t * a(i, j);
    a(i, j) = a(j, i) = 0;
    const double ki = a(k, i), kj = a(k, j);
    a(k, i) = a(i, k) = c * ki - s * kj;
    a(k, j) = a(j, k) = s * ki + c * kj;
    for (int row = 0; row < 3; ++row) {
        const double x = v(row, i), y = v(row, j);
        v(row, i) = c * x - s * y;
        v(row, j) = s * x + c * y;
    }
}
} // namespace

core::Vec<double> with_fixed_sign(const core::Vec<double>& direction)
{
    int largest = 0;
    for (int i = 1; i < 3; ++i) // clearly larger only: equal magnitudes must not be decided by rounding
        if (std::abs(direction[i]) > std::abs(direction[largest]) * (1 + 1e-9)) largest = i;
    return direction[largest] < 0 ? -1.0 * direction : direction;
}

Principal principal(const core::Sym<double>& tensor)
{
    core::Mat<double> a{}, v = core::identity<double>();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) a(i, j) = tensor(i, j);
    const double size = core::contract(tensor, tensor);
    CLEAVE_EXPECTS(std::isfinite(size));
    // Convergence is quadratic: five sweeps reach rounding, the bound only ends a broken input.
    for (int sweep = 0; sweep < 12; ++sweep) {
        const double off = a(0, 1) * a(0, 1) + a(1, 2) * a(1, 2) + a(2, 0) * a(2, 0);
        if (!(off > 1e-34 * size)) break;
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }

    std::array<int, 3> order{0, 1, 2};
    const auto sort_pair = [&](std::size_t x, std::size_t y) {
        if (a(order[x], order[x]) < a(order[y], order[y])) std::swap(order[x], order[y]);
    };
    sort_pair(0, 1);
    sort_pair(1, 2);
    sort_pair(0, 1);

    Principal result{};
    for (std::size_t k = 0; k < 3; ++k) {
        const int column = order[k];
        result.value[k] = a(column, column);
        result.direction[k] = with_fixed_sign({{v(0, column), v(1, column), v(2, column)}});
    }
    result.direction[2] = core::cross(result.direction[0], result.direction[1]);
    return result;
}
} // namespace material
