/// One table of a case file, read key by key through the table of io/keys.h.
///
/// Every read checks type, unit and range, falls back to the default, and records the value in mm-g-ms for
/// resolved.toml. Wrong input adds an error and yields a harmless value, so that reading goes on and finds the rest.
#pragma once

#include "io/value_reader.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
using Pair = std::array<Real, 2>;
using FreeVector = std::array<std::optional<Real>, 3>;

class SectionReader
{
public:
    /// @param table   null: the section is not in the file, every key takes its default
    /// @param schema  section of the key table, "material.decohesion"
    /// @param path    as the user wrote it, "material.steel.decohesion"
    /// @param place   where to complain about missing keys when there is no table
    SectionReader(Diagnostics& diagnostics, const Node* table, std::string schema, std::string path,
                  const Place& place);

    bool has(std::string_view name) const { return find(name) != nullptr; }
    /// The value as written, null if absent. Tables and shapes are read from it by others.
    const Node* find(std::string_view name) const { return table_ ? table_->find(name) : nullptr; }
    /// Place of a value, of the section if absent.
    const Place& place(std::string_view name) const;
    const Place& place() const { return place_; }
    const std::string& path() const { return path_; }

    bool boolean(std::string_view name);
    bool boolean(std::string_view name, bool fallback);
    int integer(std::string_view name); // 1 after an error
    std::optional<std::int64_t> optional_integer(std::string_view name);
    Real real(std::string_view name); // NaN after an error
    /// Default that depends on other keys (a preset) instead of the table's.
    Real real(std::string_view name, Real fallback);
    std::optional<Real> optional_real(std::string_view name);
    std::string text(std::string_view name);
    std::optional<std::string> optional_text(std::string_view name);
    /// Position in Key::choices, which stand in the order of the enumeration.
    template <class Enum>
    Enum choice(std::string_view name, Enum fallback = Enum{})
    {
        return static_cast<Enum>(choice_index(name, static_cast<std::size_t>(fallback)));
    }
    std::string choice_name(std::string_view name);
    int axis(std::string_view name);
    std::optional<int> optional_axis(std::string_view name);
    Vec3 vector(std::string_view name);
    std::optional<Vec3> optional_vector(std::string_view name);
    std::vector<std::string> names(std::string_view name);
    /// Names of which none may stand twice.
    std::vector<std::string> distinct_names(std::string_view name);
    std::vector<Vec3> points(std::string_view name);
    std::vector<Pair> corners(std::string_view name);
    /// One velocity along `axis`, or three with "free" components.
    FreeVector velocity(std::string_view name, std::optional<int> axis);

    /// Add an error at a key of this section.
    void error(std::string_view name, std::string message, std::string beside = "");

    /// Write a value into the resolved table; reads do it themselves.
    void record(std::string_view name, Node value) { resolved_.set(name, std::move(value)); }
    /// The same for a table within this one, once it is read; it is written on the line of its name.
    void record(std::string_view name, const SectionReader& own);
    /// Complain about keys that no table entry knows. Call when every key is read.
    void finish();
    bool sound() const { return diagnostics_.error_count() == errors_before_; }
    const Node& resolved() const { return resolved_; }

private:
    /// The value in the file or the default; null (and an error, if required) when there is neither.
    const Node* value(const Key& key);
    std::size_t choice_index(std::string_view name, std::size_t fallback);
    const Key& key(std::string_view name) const { return key_of(schema_, name); }

    Diagnostics& diagnostics_;
    const Node* table_;
    std::string schema_;
    std::string path_;
    Place place_;
    std::size_t errors_before_;
    Node fallback_; // the default under way
    Node resolved_;
};
} // namespace io
