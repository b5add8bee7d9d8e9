/// Single values of a case file, checked against the type, unit and range their key asks for.
///
/// What does not fit becomes an error with its place, and nothing is returned.
#pragma once

#include "io/document.h"
#include "io/keys.h"

#include <optional>
#include <string>

namespace io
{
/// A number, or text with a unit, in mm-g-ms (wall times in s).
std::optional<Real> read_real(const Node& value, const Key& key, Diagnostics& diagnostics);
std::optional<Vec3> read_vector(const Node& value, const Key& key, Diagnostics& diagnostics);
std::optional<std::string> read_text(const Node& value, const Key& key, Diagnostics& diagnostics);
/// 0, 1, 2 for "x", "y", "z".
std::optional<int> read_axis(const Node& value, const Key& key, Diagnostics& diagnostics);

bool in_range(Real value, Range range);

/// The complaint about a value of the wrong type.
void type_error(const Node& value, const Key& key, Diagnostics& diagnostics);
} // namespace io
