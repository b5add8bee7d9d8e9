/// material/principal.h: decomposition, order, handedness, equal values.
#include "material/principal.h"

#include "tests/material/samples.h"

#include <gtest/gtest.h>

namespace material
{
namespace
{
void expect_decomposition(const Sym& tensor)
{
    const Principal p = principal(tensor);
    EXPECT_GE(p.value[0], p.value[1]);
    EXPECT_GE(p.value[1], p.value[2]);
    Sym rebuilt{};
    for (std::size_t k = 0; k < 3; ++k) rebuilt = rebuilt + p.value[k] * dyad(p.direction[k], p.direction[k]);
    EXPECT_LT(norm(rebuilt - tensor), 8e-15 * norm(tensor));
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR(core::dot(p.direction[i], p.direction[j]), i == j ? 1 : 0, 6e-15);
    EXPECT_GT(core::dot(core::cross(p.direction[0], p.direction[1]), p.direction[2]), 0.99);
}
} // namespace

TEST(Principal, rebuilds_random_tensors)
{
    Samples samples;
    for (int k = 0; k < 1000; ++k) expect_decomposition(samples.tensor(1000));
}

TEST(Principal, rebuilds_close_and_equal_values_in_any_frame)
{
    Samples samples;
    for (const double gap : {0.0, 1e-15, 1e-12, 1e-9, 1e-6})
        for (int k = 0; k < 50; ++k) {
            const Mat r = samples.rotation();
            expect_decomposition(core::rotated(r, Sym{{1 + gap, 1, -1, 0, 0, 0}}));
            expect_decomposition(core::rotated(r, Sym{{1, -1, -1 - gap, 0, 0, 0}}));
            expect_decomposition(core::rotated(r, Sym{{2 + gap, 2, 2, 0, 0, 0}}));
        }
}

TEST(Principal, handles_diagonal_and_zero)
{
    const Principal p = principal(Sym{{1, 3, 2, 0, 0, 0}});
    EXPECT_EQ(p.value[0], 3);
    EXPECT_EQ(p.value[1], 2);
    EXPECT_EQ(p.value[2], 1);
    EXPECT_EQ(p.direction[0][1], 1);
    EXPECT_EQ(p.direction[1][2], 1);
    const Principal zero = principal(Sym{});
    EXPECT_EQ(zero.value[0], 0);
    EXPECT_EQ(zero.direction[0][0], 1);
}

TEST(Principal, sign_is_fixed_and_not_decided_by_rounding)
{
    Samples samples;
    for (int k = 0; k < 100; ++k) {
        const Vec v = samples.vector(1);
        const Vec a = with_fixed_sign(v), b = with_fixed_sign(-1.0 * v);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(a[i], b[i]);
    }
    const double h = std::sqrt(0.5);
    EXPECT_GT(with_fixed_sign({{h, -h * (1 + 1e-15), 0}})[0], 0);
    EXPECT_GT(with_fixed_sign({{h * (1 + 1e-15), -h, 0}})[0], 0);
}
} // namespace material
