/// Units of case files: dimensions as exponents of length, mass and time, and text such as "7.81e-3 g/mm^3".
///
/// Everything becomes the set mm-g-ms: force N, stress MPa, energy mJ, speed mm/ms = m/s. A bare number is already in
/// it; quoted text names its unit and is checked against the dimension the key asks for.
#pragma once

#include "core/real.h"

#include <string>
#include <string_view>
#include <variant>

namespace io
{
struct Dimension
{
    int length = 0;
    int mass = 0;
    int time = 0;
    bool operator==(const Dimension&) const = default;
};

namespace dimension
{
inline constexpr Dimension none{};
inline constexpr Dimension length{1, 0, 0};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension rate{0, 0, -1};
inline constexpr Dimension velocity{1, 0, -1};
inline constexpr Dimension acceleration{1, 0, -2};
inline constexpr Dimension density{-3, 1, 0};
inline constexpr Dimension stress{-1, 1, -2};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension energy_per_area{0, 1, -2};
} // namespace dimension

struct Quantity
{
    Real value = 0; // in mm-g-ms
    Dimension dimension;
};

/// Why a text is not a quantity, in words for the user.
struct UnitProblem
{
    std::string text;
};

/// Read "195 GPa", "2e-7 m", "7.81e-3 g/mm^3", "100 kJ/m^2", "0.3", "inf".
///
/// Grammar: number, then factors unit[^exponent] joined by '*', '/' or a blank; '/' inverts only the factor after it.
std::variant<Quantity, UnitProblem> parse_quantity(std::string_view text);

/// The unit of a dimension in mm-g-ms in its common name: "MPa", "mm/ms", "1" for none.
std::string unit_name(const Dimension& dimension);

/// What such a quantity is called: "stress", "length", "number without unit".
std::string quantity_name(const Dimension& dimension);

/// An example with a unit for error messages: "\"195 GPa\"".
std::string unit_example(const Dimension& dimension);
} // namespace io
