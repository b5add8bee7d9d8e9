#include "material/lode_memory.h"

#include <gtest/gtest.h>

#include <cmath>

using material::remembered_lode;

// dL_m / de = (L - L_m) / e_m
TEST(LodeMemory, forgets_exponentially_with_the_plastic_strain)
{
    EXPECT_EQ(remembered_lode(-0.8, 0.3, 0, 0.05), -0.8); // a wave that is elastic
    EXPECT_NEAR(remembered_lode(-0.8, 0.2, 0.05, 0.05), 0.2 - std::exp(-1.0), 1e-15);
    EXPECT_NEAR(remembered_lode(-0.8, 0.2, 5, 0.05), 0.2, 1e-15);
    const double step = 1e-6;
    EXPECT_NEAR((remembered_lode(-0.8, 0.2, step, 0.05) + 0.8) / step, 1 / 0.05, 1e-3);
}

TEST(LodeMemory, does_not_depend_on_how_often_it_is_asked)
{
    double often = -0.9;
    for (int n = 0; n < 100; ++n) often = remembered_lode(often, -0.2, 4e-4, 0.03);
    EXPECT_NEAR(often, remembered_lode(-0.9, -0.2, 0.04, 0.03), 1e-14);
}
