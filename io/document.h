/// A case file as a plain tree with the place of every key and value: the only knowledge of TOML is in document.cpp.
///
/// `include = "common.toml"` (or a list) at the top of a file reads other files first, relative to it. The including
/// file wins key by key; arrays of tables such as [[refine.zone]] are joined, included ones first.
#pragma once

#include "core/real.h"
#include "io/diagnostics.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
struct Entry;

struct Node
{
    enum class Kind
    {
        boolean,
        integer,
        real,
        text,
        list,
        table,
        other, // dates and times: no key takes one
    };
    Kind kind = Kind::table;
    Place place;
    bool boolean = false;
    std::int64_t integer = 0;
    Real real = 0;
    std::string text;
    std::vector<Node> items;    // of a list
    std::vector<Entry> entries; // of a table, in the order of the file
    bool section = false;       // a table written as [name], a list written as [[name]]

    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
    /// Set the value at `key`, keeping its place in the order if it was there. Returns the value.
    Node& set(std::string_view key, Node value);
};

struct Entry
{
    std::string key;
    Place place;
    Node value;
};

Node node(bool value);
Node node(std::int64_t value);
Node node(Real value);
Node node(std::string_view value);
Node list_of(std::vector<Node> items);

/// What complaints about overrides name instead of a file.
inline constexpr std::string_view override_source = "--set";

/// Read a case file with what it includes, then apply overrides "grid.cell=0.5" (a value that is not TOML is text, so
/// that `end.time=0.2 ms` works; tables of an array are counted from 0: "refine.zone.0.level=2").
///
/// Syntax errors, missing includes and unusable overrides go to `diagnostics`; the tree holds what could be read.
/// @error core::FileError if `file` itself cannot be read
Node load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                   Diagnostics& diagnostics);

/// Read one TOML value from text the program itself holds, such as a default.
/// @pre the text is valid
Node parse_value(std::string_view text);

/// TOML text of a tree: tables marked `section` get headers, every other table is inline.
std::string write_document(const Node& root);

/// TOML text of one value, tables inline. Reals are written so that reading them gives the same bits.
std::string write_value(const Node& value);
} // namespace io
