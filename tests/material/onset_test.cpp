/// material/onset.h: the cheap test never clears a stress that the exact criteria would start.
#include "material/onset.h"

#include "core/simd.h"
#include "material/principal.h"
#include "tests/material/samples.h"

#include <gtest/gtest.h>

#include <limits>

namespace material
{
namespace
{
constexpr double infinite = std::numeric_limits<double>::infinity();

bool starts(const Sym& stress, double s_max, double tau_max)
{
    const Principal p = principal(stress);
    return p.value[0] > s_max || (p.value[0] - p.value[2]) / 2 > tau_max;
}
} // namespace

TEST(MayStart, never_clears_what_starts_and_clears_most_of_the_rest)
{
    Samples samples;
    int starting = 0, cleared = 0, false_alarms = 0;
    for (int k = 0; k < 20000; ++k) {
        const Sym stress = samples.tensor(1000);
        const double s_max = samples.uniform(500, 2500), tau_max = samples.uniform(500, 2000);
        const bool flagged = may_start(stress, s_max, tau_max);
        if (starts(stress, s_max, tau_max)) {
            ++starting;
            ASSERT_TRUE(flagged);
        } else {
            ++(flagged ? false_alarms : cleared);
        }
    }
    EXPECT_GT(starting, 2000);
    EXPECT_GT(cleared, 3 * false_alarms);
}

TEST(MayStart, is_sharp_in_uniaxial_tension_and_pure_shear)
{
    EXPECT_TRUE(may_start(Sym{{1000.001, 0, 0, 0, 0, 0}}, 1000.0, infinite));
    EXPECT_FALSE(may_start(Sym{{999.9, 0, 0, 0, 0, 0}}, 1000.0, infinite));
    EXPECT_TRUE(may_start(Sym{{0, 0, 0, 820.001, 0, 0}}, infinite, 820.0));
    EXPECT_FALSE(may_start(Sym{{0, 0, 0, 819.9, 0, 0}}, infinite, 820.0));
}

TEST(MayStart, sees_hydrostatic_tension_beyond_the_strength)
{
    EXPECT_TRUE(may_start(Sym{{5000, 5000, 5000, 0, 0, 0}}, 4900.0, infinite));
    EXPECT_FALSE(may_start(Sym{{-5000, -5000, -5000, 0, 0, 0}}, 4900.0, 820.0));
}

TEST(MayStart, infinite_strengths_never_flag)
{
    EXPECT_FALSE(may_start(Sym{{1e6, -1e6, 1e5, 1e6, 0, 0}}, infinite, infinite));
}

TEST(MayStart, lanes_decide_like_scalar)
{
    using Lanes = core::Pack<double, core::native_lanes<double>>;
    Samples samples;
    for (int k = 0; k < 200; ++k) {
        core::Sym<Lanes> stress{};
        std::array<Sym, Lanes::lanes> stresses;
        for (int lane = 0; lane < Lanes::lanes; ++lane) {
            stresses[static_cast<std::size_t>(lane)] = samples.tensor(1000);
            for (int i = 0; i < 6; ++i) stress[i].v[lane] = stresses[static_cast<std::size_t>(lane)][i];
        }
        const auto flagged = may_start(stress, Lanes(1200.0), Lanes(900.0));
        for (int lane = 0; lane < Lanes::lanes; ++lane)
            EXPECT_EQ(flagged[lane], may_start(stresses[static_cast<std::size_t>(lane)], 1200.0, 900.0));
    }
}
} // namespace material
