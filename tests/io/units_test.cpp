#include "io/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using io::Dimension;

struct Row
{
    const char* text;
    Real value; // mm-g-ms
    Dimension dimension;
};

TEST(Units, quantities_become_mm_g_ms)
{
    const Row rows[] = {
        {"195 GPa", 195e3, io::dimension::stress},
        {"2e-7 m", 2e-4, io::dimension::length},
        {"5 m/s", 5, io::dimension::velocity},
        {"0.05 ms", 0.05, io::dimension::time},
        {"20 min", 1.2e6, io::dimension::time},
        {"7.81e-3 g/mm^3", 7.81e-3, io::dimension::density},
        {"7810 kg/m^3", 7.81e-3, io::dimension::density},
        {"7810 kg m^-3", 7.81e-3, io::dimension::density},
        {"100 kJ/m^2", 100, io::dimension::energy_per_area},
        {"100 N/mm", 100, io::dimension::energy_per_area},
        {"9.81 m/s^2", 9.81e-3, io::dimension::acceleration},
        {"9.81 m/s/s", 9.81e-3, io::dimension::acceleration},
        {"8.4 kN", 8400, io::dimension::force},
        {"1 kg*m/s^2", 1, io::dimension::force},
        {"  -3mm ", -3, io::dimension::length},
        {"+1e3", 1000, io::dimension::none},
        {"50 %", 0.5, io::dimension::none},
        {"inf", std::numeric_limits<Real>::infinity(), io::dimension::none},
    };
    for (const Row& row : rows) {
        const auto read = io::parse_quantity(row.text);
        ASSERT_TRUE(std::holds_alternative<io::Quantity>(read)) << row.text;
        const auto quantity = std::get<io::Quantity>(read);
        if (std::isfinite(row.value))
            EXPECT_NEAR(quantity.value, row.value, 1e-14 * std::abs(row.value)) << row.text;
        else
            EXPECT_EQ(quantity.value, row.value) << row.text;
        EXPECT_EQ(quantity.dimension, row.dimension) << row.text;
    }
}

TEST(Units, what_is_no_quantity_says_why)
{
    const std::pair<const char*, const char*> rows[] = {
        {"fast", "'fast' does not begin with a number"},     {"", "'' does not begin with a number"},
        {"5 furlong", "'furlong' is not a unit known here"}, {"5 m/", "'5 m/' does not end in a unit"},
        {"5 m^x", "'5 m^x' has no whole number after '^'"},  {"5 6", "'5 6' does not end in a unit"},
    };
    for (const auto& [text, reason] : rows) {
        const auto read = io::parse_quantity(text);
        ASSERT_TRUE(std::holds_alternative<io::UnitProblem>(read)) << text;
        EXPECT_EQ(std::get<io::UnitProblem>(read).text, reason);
    }
}
} // namespace
