// Stability of nested impulses on the bar of methods.md A.7, by the spectral radius of one step of the coarsest level.
#include "core/real.h"
#include "solver/stable_time_step.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <vector>

namespace
{
using Matrix = Eigen::MatrixXd;

/// Bar with free ends, E = rho = h_f = 1: `cells` cells of every level, finest first; level l has spacing 2^l.
struct Bar
{
    Matrix per_mass;               // M^-1
    std::vector<Matrix> stiffness; // [level]
};

Bar bar_of(const std::vector<int>& cells)
{
    int elements = 0;
    for (const int count : cells) elements += count;
    const int nodes = elements + 1;
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(nodes);
    Bar bar;
    int node = 0;
    for (std::size_t l = 0; l < cells.size(); ++l) {
        Matrix k = Matrix::Zero(nodes, nodes);
        const Real h = 1 << l;
        for (int n = 0; n < cells[l]; ++n, ++node) {
            k.block(node, node, 2, 2) += (Matrix(2, 2) << 1 / h, -1 / h, -1 / h, 1 / h).finished();
            mass.segment(node, 2).array() += h / 2;
        }
        bar.stiffness.push_back(k);
    }
    bar.per_mass = mass.cwiseInverse().asDiagonal();
    return bar;
}

/// v += dt M^-1 f and u += dt v on states (u, v).
Matrix kick(const Matrix& per_mass_stiffness, Real dt)
{
    const auto n = per_mass_stiffness.rows();
    Matrix g = Matrix::Identity(2 * n, 2 * n);
    g.bottomLeftCorner(n, n) = -dt * per_mass_stiffness;
    return g;
}
Matrix drift(Eigen::Index n, Real dt)
{
    Matrix g = Matrix::Identity(2 * n, 2 * n);
    g.topRightCorner(n, n) = dt * Matrix::Identity(n, n);
    return g;
}

Real radius(const Matrix& step)
{
    return step.eigenvalues().cwiseAbs().maxCoeff();
}

Real impulse_radius(const Bar& bar, Real dt)
{
    const auto n = bar.per_mass.rows();
    Matrix g = Matrix::Identity(2 * n, 2 * n);
    for (int s = 0; s < 1 << (bar.stiffness.size() - 1); ++s) {
        for (std::size_t l = bar.stiffness.size(); l-- > 0;)
            if (s % (1 << l) == 0) g = kick(bar.per_mass * bar.stiffness[l], dt * (1 << l)) * g;
        g = drift(n, dt) * g;
    }
    return radius(g);
}

/// Two levels, the slow force of the beginning given in equal parts with both fine steps.
Real frozen_radius(const Bar& bar, Real dt)
{
    const auto n = bar.per_mass.rows();
    const Matrix fast = drift(n, dt) * kick(bar.per_mass * bar.stiffness[0], dt);
    Matrix slow = Matrix::Zero(2 * n, 2 * n); // what the slow force adds to (u, v) in one fine step, before the drift
    slow.bottomLeftCorner(n, n) = -dt * bar.per_mass * bar.stiffness[1];
    const Matrix pushed = drift(n, dt) * slow;
    return radius(fast * (fast + pushed) + pushed);
}

constexpr Real rounding = 1e-6; // two eigenvalues of the free motion coincide at 1
} // namespace

TEST(Subcycling, nested_impulses_are_stable_up_to_a_cfl_of_0_7)
{
    EXPECT_LE(solver::subcycled_step_share, 0.7);
    for (const std::vector<int>& cells :
         {std::vector<int>{8, 4}, {16, 8}, {24, 6}, {7, 15}, {8, 4, 4}, {16, 6, 5}, {4, 4, 9}})
        for (Real cfl = 0.05; cfl < 0.701; cfl += 0.05)
            EXPECT_LT(impulse_radius(bar_of(cells), cfl), 1 + rounding) << cells[0] << ' ' << cells[1] << ' ' << cfl;
}

TEST(Subcycling, nested_impulses_resonate_beyond)
{
    Real largest = 0;
    for (Real cfl = 0.72; cfl < 0.8; cfl += 0.005) largest = std::max(largest, impulse_radius(bar_of({16, 8}), cfl));
    EXPECT_GT(largest, 1.001);
}

// In the second fine step the slow force is dt late, and lateness feeds a mode of frequency w by w^2 dt^2 / 2 per step;
// the coarse cells reach w = 2 c / h_c = c / h_f.
TEST(Subcycling, a_frozen_slow_force_is_unstable_at_any_cfl)
{
    const Bar bar = bar_of({16, 8});
    for (const Real cfl : {0.05, 0.1, 0.3, 0.5, 0.6})
        EXPECT_NEAR((frozen_radius(bar, cfl) - 1) / (cfl * cfl / 2), 0.95, 0.1) << cfl;
}
