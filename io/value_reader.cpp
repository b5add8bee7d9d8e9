#include "io/value_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace io
{
void type_error(const Node& value, const Key& key, Diagnostics& diagnostics)
{
    diagnostics.error(value.place, fmt::format("'{}' has the wrong type", key.name),
                      fmt::format("expected {}", expected(key)));
}

bool in_range(Real value, Range range)
{
    switch (range) {
    case Range::finite:
        return std::isfinite(value);
    case Range::positive:
        return std::isfinite(value) && value > 0;
    case Range::non_negative:
        return std::isfinite(value) && value >= 0;
    case Range::share:
        return value >= 0 && value <= 1;
    case Range::poisson:
        return value > -1 && value < 0.5;
    case Range::positive_or_inf:
        return value > 0;
    case Range::any_or_inf:
        return !std::isnan(value);
    }
    return false;
}

std::optional<std::string> read_text(const Node& value, const Key& key, Diagnostics& diagnostics)
{
    if (value.kind == Node::Kind::text) return value.text;
    type_error(value, key, diagnostics);
    return std::nullopt;
}

std::optional<int> read_axis(const Node& value, const Key& key, Diagnostics& diagnostics)
{
    constexpr std::string_view letters = "xyz";
    if (value.kind == Node::Kind::text && value.text.size() == 1)
        if (const std::size_t found = letters.find(value.text); found != std::string_view::npos)
            return static_cast<int>(found);
    diagnostics.error(value.place, fmt::format("'{}' is not an axis", key.name),
                      fmt::format("expected {}", expected(key)));
    return std::nullopt;
}

std::optional<Real> read_real(const Node& value, const Key& key, Diagnostics& diagnostics)
{
    const bool wall = key.type == Type::wall_time;
    Real number = 0;
    if (value.kind == Node::Kind::integer)
        number = static_cast<Real>(value.integer);
    else if (value.kind == Node::Kind::real)
        number = value.real;
    else if (value.kind == Node::Kind::text) {
        const std::variant<Quantity, UnitProblem> read = parse_quantity(value.text);
        if (const UnitProblem* problem = std::get_if<UnitProblem>(&read)) {
            diagnostics.error(value.place, problem->text, fmt::format("expected {}", expected(key)));
            return std::nullopt;
        }
        const Quantity& quantity = std::get<Quantity>(read);
        if (quantity.dimension != key.dimension && !(quantity.dimension == dimension::none)) {
            diagnostics.error(value.place,
                              fmt::format("'{}' is a {}, but '{}' is a {}", value.text,
                                          quantity_name(quantity.dimension), key.name, quantity_name(key.dimension)),
                              wall
                                  ? fmt::format("expected {}", expected(key)) // has its example
                                  : fmt::format("expected {}, such as {}", expected(key), unit_example(key.dimension)));
            return std::nullopt;
        }
        number = quantity.value;
        // Wall times are kept in seconds, and so is a bare number of them.
        if (wall && quantity.dimension == dimension::time) number /= 1000;
    } else {
        type_error(value, key, diagnostics);
        return std::nullopt;
    }
    if (in_range(number, key.range)) return number;
    diagnostics.error(value.place,
                      std::isfinite(number) ? fmt::format("'{}' is out of range: {}", key.name, number)
                                            : fmt::format("'{}' must be a finite number, not {}", key.name, number),
                      fmt::format("expected {}", expected(key)));
    return std::nullopt;
}

std::optional<Vec3> read_vector(const Node& value, const Key& key, Diagnostics& diagnostics)
{
    if (value.kind != Node::Kind::list || value.items.size() != 3) {
        type_error(value, key, diagnostics);
        return std::nullopt;
    }
    Vec3 out;
    bool sound = true;
    Key component = key;
    component.type = Type::real;
    for (int a = 0; a < 3; ++a) {
        const std::optional<Real> read = read_real(value.items[static_cast<std::size_t>(a)], component, diagnostics);
        out[a] = read.value_or(std::numeric_limits<Real>::quiet_NaN());
        sound = sound && read;
    }
    return sound ? std::optional(out) : std::nullopt;
}

} // namespace io
