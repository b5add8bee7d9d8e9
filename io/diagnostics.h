/// Complaints about a case file, gathered so that one run reports every error, each with its place:
///
///   sfc1.toml:41:1: error: unknown key 'tau_mx' in [material.steel.decohesion]
///      41 | tau_mx = "820 MPa"
///         | ^~~~~~  did you mean 'tau_max'?
///      keys here: ...
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
/// Where something was read. `file` indexes Diagnostics' list of sources; -1: nowhere.
struct Place
{
    int file = -1;
    int line = 1;
    int column = 1;
    int length = 1; // characters to underline
};

struct Complaint
{
    Place place;
    std::string message, beside;
    std::vector<std::string> notes;
    bool of_key = false; // about a name that is no key or item there, whatever its value
};

class Diagnostics
{
public:
    /// Register a text whose lines later complaints quote; returns its number for Place::file.
    int add_source(std::string name, std::string_view text);

    /// @param beside  stands beside the caret ("did you mean 'tau_max'?")
    /// @param notes   lines below it
    void error(const Place& place, std::string message, std::string beside = "", std::vector<std::string> notes = {});
    /// The same about a name that is no key or item there, whatever its value.
    void key_error(const Place& place, std::string message, std::string beside = "",
                   std::vector<std::string> notes = {});
    void warning(const Place& place, std::string message, std::string beside = "");

    std::size_t error_count() const { return errors_.size(); }
    /// Keep the first `count` errors only: what followed was one mistake, to be told as such.
    void forget_errors(std::size_t count);
    /// Name of the text that a place is in; empty for no place.
    std::string_view source_name(const Place& place) const;
    std::size_t source_count() const { return sources_.size(); }
    /// The first error about a name in a text; nothing if there is none.
    std::optional<Complaint> key_error_in(std::size_t source) const;
    /// Every error in the order of files and lines, with a last line that counts them.
    std::string error_text() const;
    std::vector<std::string> warning_texts() const;

private:
    struct Source
    {
        std::string name;
        std::vector<std::string> lines;
    };
    std::string format(const Complaint& complaint, std::string_view kind) const;

    std::vector<Source> sources_;
    std::vector<Complaint> errors_;
    std::vector<Complaint> warnings_;
};

/// The candidate nearest to a misspelt name by edit distance (a swap of neighbours counts once), or empty when nothing
/// is close enough to be meant.
std::string nearest_name(std::string_view misspelt, const std::vector<std::string>& candidates);

/// `before` and "did you mean 'x'?" with the nearest candidate, or nothing.
std::string nearest_hint(std::string_view misspelt, const std::vector<std::string>& candidates,
                         std::string_view before = "");

/// "a, b, c".
std::string joined(const std::vector<std::string>& names, std::string_view separator = ", ");
} // namespace io
