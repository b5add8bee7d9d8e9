/// Enumerators of [numerics] as they stand in a case file.
#pragma once

#include "io/keys.h"

#include <string>
#include <string_view>

namespace app
{
/// @param key  of [numerics], whose choices stand in the order of the enumeration
template <class Enum>
std::string choice_name(std::string_view key, Enum value)
{
    return io::choices_of(io::key_of("numerics", key)).at(static_cast<std::size_t>(value));
}
} // namespace app
