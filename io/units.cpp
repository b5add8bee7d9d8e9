#include "io/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace io
{
namespace
{
struct Unit
{
    std::string_view symbol;
    Real factor; // of the unit in mm-g-ms
    Dimension dimension;
};

constexpr std::array units{
    Unit{"m", 1e3, dimension::length},
    Unit{"cm", 10, dimension::length},
    Unit{"mm", 1, dimension::length},
    Unit{"um", 1e-3, dimension::length},
    Unit{"in", 25.4, dimension::length},
    Unit{"kg", 1e3, {0, 1, 0}},
    Unit{"g", 1, {0, 1, 0}},
    Unit{"mg", 1e-3, {0, 1, 0}},
    Unit{"t", 1e6, {0, 1, 0}},
    Unit{"s", 1e3, dimension::time},
    Unit{"ms", 1, dimension::time},
    Unit{"us", 1e-3, dimension::time},
    Unit{"min", 6e4, dimension::time},
    Unit{"h", 3.6e6, dimension::time},
    Unit{"N", 1, dimension::force},
    Unit{"kN", 1e3, dimension::force},
    Unit{"MN", 1e6, dimension::force},
    Unit{"Pa", 1e-6, dimension::stress},
    Unit{"kPa", 1e-3, dimension::stress},
    Unit{"MPa", 1, dimension::stress},
    Unit{"GPa", 1e3, dimension::stress},
    Unit{"J", 1e3, {2, 1, -2}},
    Unit{"mJ", 1, {2, 1, -2}},
    Unit{"kJ", 1e6, {2, 1, -2}},
    Unit{"%", 1e-2, dimension::none},
};

struct Named
{
    Dimension dimension;
    std::string_view unit, name, example;
};

constexpr std::array named{
    Named{dimension::none, "1", "number without unit", "0.5"},
    Named{dimension::length, "mm", "length", "\"0.25 mm\""},
    Named{dimension::time, "ms", "time", "\"0.05 ms\""},
    Named{dimension::rate, "1/ms", "rate", "0.5"},
    Named{dimension::velocity, "mm/ms", "velocity", "\"5 m/s\""},
    Named{dimension::acceleration, "mm/ms^2", "acceleration", "\"9.81 m/s^2\""},
    Named{dimension::density, "g/mm^3", "density", "\"7.81e-3 g/mm^3\""},
    Named{dimension::stress, "MPa", "stress", "\"195 GPa\""},
    Named{dimension::force, "N", "force", "\"8.4 kN\""},
    Named{dimension::energy_per_area, "N/mm", "energy per area", "\"100 kJ/m^2\""},
};

const Named* find_named(const Dimension& dimension)
{
    for (const Named& entry : named)
        if (entry.dimension == dimension) return &entry;
    return nullptr;
}

const Unit* find_unit(std::string_view symbol)
{
    for (const Unit& unit : units)
        if (unit.symbol == symbol) return &unit;
    return nullptr;
}

void skip_blanks(std::string_view& text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

/// Take the leading number off `text`; empty if there is none.
template <class Number>
std::optional<Number> take_number(std::string_view& text)
{
    std::string_view digits = text;
    if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
    Number value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc()) return std::nullopt;
    text = digits.substr(static_cast<std::size_t>(end - digits.data()));
    return value;
}

std::string_view take_symbol(std::string_view& text)
{
    std::size_t size = 0;
    while (size < text.size() && std::string_view(" \t*/^0123456789+-.").find(text[size]) == std::string_view::npos)
        ++size;
    const std::string_view symbol = text.substr(0, size);
    text.remove_prefix(size);
    return symbol;
}
} // namespace

std::variant<Quantity, UnitProblem> parse_quantity(std::string_view text)
{
    const std::string_view whole = text;
    skip_blanks(text);
    const std::optional<Real> number = take_number<Real>(text);
    if (!number) return UnitProblem{fmt::format("'{}' does not begin with a number", whole)};
    Quantity quantity{*number, {}};
    skip_blanks(text);
    for (bool first = true; !text.empty(); first = false) {
        int sign = 1;
        if (!first && (text.front() == '/' || text.front() == '*')) {
            sign = text.front() == '/' ? -1 : 1;
            text.remove_prefix(1);
            skip_blanks(text);
        }
        const std::string_view symbol = take_symbol(text);
        const Unit* unit = find_unit(symbol);
        if (!unit)
            return UnitProblem{symbol.empty() ? fmt::format("'{}' does not end in a unit", whole)
                                              : fmt::format("'{}' is not a unit known here", symbol)};
        int exponent = 1;
        if (!text.empty() && text.front() == '^') {
            text.remove_prefix(1);
            const std::optional<int> read = take_number<int>(text);
            if (!read) return UnitProblem{fmt::format("'{}' has no whole number after '^'", whole)};
            exponent = *read;
        }
        exponent *= sign;
        quantity.value *= std::pow(unit->factor, exponent);
        quantity.dimension.length += exponent * unit->dimension.length;
        quantity.dimension.mass += exponent * unit->dimension.mass;
        quantity.dimension.time += exponent * unit->dimension.time;
        skip_blanks(text);
    }
    return quantity;
}

std::string unit_name(const Dimension& dimension)
{
    if (const Named* entry = find_named(dimension)) return std::string(entry->unit);
    return fmt::format("mm^{} g^{} ms^{}", dimension.length, dimension.mass, dimension.time);
}

std::string quantity_name(const Dimension& dimension)
{
    if (const Named* entry = find_named(dimension)) return std::string(entry->name);
    return "quantity in " + unit_name(dimension);
}

std::string unit_example(const Dimension& dimension)
{
    const Named* entry = find_named(dimension);
    return std::string(entry ? entry->example : "");
}
} // namespace io
