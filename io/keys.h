/// Every key a case file may hold: section, type, unit, default, meaning. One table drives the reader, the detection of
/// unknown keys, `cleave keys` and resolved.toml.
#pragma once

#include "io/units.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
enum class Type
{
    boolean,
    integer,
    real,
    wall_time, // s of the wall, not ms of the run
    text,
    choice,   // one of Key::choices
    axis,     // "x", "y", "z"
    vector,   // three reals
    velocity, // three reals or "free", or one real along `axis`
    names,    // list of texts
    values,   // list of values of any type, or of such lists
    points,   // list of vectors
    corners,  // list of pairs
    shape,    // section "shape"
    shapes,   // list of shapes
    table,    // section "<section>.<name>" or as the meaning says
};

enum class Presence
{
    required,
    defaulted, // Key::fallback
    optional,  // absent means something; the meaning says what
};

/// Interval a number must lie in.
enum class Range
{
    finite,
    positive,
    non_negative,
    share,   // [0, 1]
    poisson, // (-1, 0.5)
    positive_or_inf,
    any_or_inf, // finite or an infinity
};

struct Key
{
    std::string_view section; // as in `cleave keys`: "grid", "refine.zone", "material.decohesion", "" for the top
    std::string_view name;
    Type type;
    Presence presence;
    std::string_view fallback; // TOML text, of a defaulted key
    std::string_view meaning;
    Dimension dimension{};
    Range range = Range::finite;
    std::string_view choices{}; // "a|b|c" in the order of the enumeration it becomes
};

std::span<const Key> all_keys();

/// The same for the files of `cleave chart` and `cleave sweep` (sections "suite" and "sweep").
std::span<const Key> study_keys();

/// The keys of one section, in the order they are shown and written.
std::vector<const Key*> keys_of(std::string_view section);

/// @pre the key exists: asking for another one is a mistake in the reader
const Key& key_of(std::string_view section, std::string_view name);

/// Every section of case files in the order of the table, the top ("") first.
std::vector<std::string> section_names();
/// Those of the files of `cleave chart` and `cleave sweep`.
std::vector<std::string> study_section_names();

/// "length > 0 [mm]", "one of 'flip', 'apic'": what a key takes.
std::string expected(const Key& key);

/// The names in "a|b|c".
std::vector<std::string> choices_of(const Key& key);
} // namespace io
