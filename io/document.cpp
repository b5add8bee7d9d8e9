#include "io/document.h"

#include "core/error.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

namespace io
{
namespace
{
Place place_of(const toml::source_region& region, int file)
{
    Place place{file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), 1};
    if (region.begin.line == region.end.line && region.end.column > region.begin.column)
        place.length = static_cast<int>(region.end.column - region.begin.column);
    return place;
}

Node converted(const toml::node& value, int file)
{
    Node out;
    out.place = place_of(value.source(), file);
    if (const toml::table* table = value.as_table()) {
        for (const auto& [key, child] : *table)
            out.entries.push_back({std::string(key.str()), place_of(key.source(), file), converted(child, file)});
        // toml++ sorts by name; errors, resolved files and the order of loads follow the file.
        std::stable_sort(out.entries.begin(), out.entries.end(), [](const Entry& a, const Entry& b) {
            return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
        });
        out.section = !table->is_inline();
        return out;
    }
    if (const toml::array* array = value.as_array()) {
        out.kind = Node::Kind::list;
        for (const toml::node& item : *array) out.items.push_back(converted(item, file));
        out.section = !out.items.empty() && out.items.front().section;
        return out;
    }
    out.kind = Node::Kind::other;
    if (const auto* text = value.as_string()) out.kind = Node::Kind::text, out.text = text->get();
    if (const auto* integer = value.as_integer()) out.kind = Node::Kind::integer, out.integer = integer->get();
    if (const auto* real = value.as_floating_point()) out.kind = Node::Kind::real, out.real = real->get();
    if (const auto* boolean = value.as_boolean()) out.kind = Node::Kind::boolean, out.boolean = boolean->get();
    return out;
}

std::optional<std::string> file_text(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file)) return std::nullopt;
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool is_number(std::string_view key)
{
    return !key.empty() && key.size() < 9 && key.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Lay `top` over `base`: tables merge, [[arrays of tables]] join, everything else is replaced. A table with numbers as
/// keys addresses the items of a list.
void overlay(Node& base, Node top, Diagnostics& diagnostics)
{
    for (Entry& entry : top.entries) {
        Node* below = nullptr;
        if (base.kind == Node::Kind::list && is_number(entry.key) && std::stoul(entry.key) < base.items.size())
            below = &base.items[std::stoul(entry.key)];
        else if (base.kind == Node::Kind::table)
            below = base.find(entry.key);
        else {
            diagnostics.key_error(entry.place, fmt::format("no item '{}' here", entry.key),
                                  fmt::format("items 0 to {}", static_cast<long>(base.items.size()) - 1));
            continue;
        }
        const bool table_above = entry.value.kind == Node::Kind::table;
        if (below && table_above && (below->kind == Node::Kind::table || below->kind == Node::Kind::list))
            overlay(*below, std::move(entry.value), diagnostics);
        else if (below && below->kind == Node::Kind::list && below->section && entry.value.section)
            below->items.insert(below->items.end(), entry.value.items.begin(), entry.value.items.end());
        else if (below)
            *below = std::move(entry.value);
        else
            base.entries.push_back(std::move(entry));
    }
}

class Loader
{
public:
    explicit Loader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    Node load(const std::filesystem::path& file, const std::string& text)
    {
        Node own = parse(text, file.string());
        open_files_.push_back(std::filesystem::weakly_canonical(file));
        Node merged;
        merged.place = own.place;
        if (const Node* include = own.find("include")) load_includes(*include, file, merged);
        open_files_.pop_back();
        std::erase_if(own.entries, [](const Entry& entry) { return entry.key == "include"; });
        overlay(merged, std::move(own), diagnostics_);
        return merged;
    }

    Node parse(const std::string& text, std::string name)
    {
        const int number = diagnostics_.add_source(name, text);
        try {
            return converted(toml::parse(std::string_view(text), std::move(name)), number);
        } catch (const toml::parse_error& problem) {
            // Of an override the key only: a value that is not TOML is text (apply_override).
            diagnostics_.key_error(place_of(problem.source(), number), std::string(problem.description()));
        }
        return {};
    }

private:
    void load_includes(const Node& include, const std::filesystem::path& from, Node& merged)
    {
        const std::vector<Node> names = include.kind == Node::Kind::list ? include.items : std::vector{include};
        for (const Node& name : names) {
            if (name.kind != Node::Kind::text) {
                diagnostics_.error(name.place, "include takes a file name or a list of file names");
                continue;
            }
            const std::filesystem::path file = from.parent_path() / name.text;
            const std::optional<std::string> text = file_text(file);
            const auto canonical = std::filesystem::weakly_canonical(file);
            if (!text)
                diagnostics_.error(name.place, fmt::format("cannot read the included file '{}'", file.string()),
                                   "relative to this file");
            else if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
                diagnostics_.error(name.place, fmt::format("'{}' includes itself", file.string()));
            else
                overlay(merged, load(file, *text), diagnostics_);
        }
    }

    Diagnostics& diagnostics_;
    std::vector<std::filesystem::path> open_files_;
};

/// "grid.cell=0.5" is TOML as it stands; "end.time=0.2 ms" becomes TOML with quotes around the value.
void apply_override(Node& root, const std::string& text, Loader& loader, Diagnostics& diagnostics)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        const int number = diagnostics.add_source(std::string(override_source), text);
        diagnostics.key_error({number, 1, 1, static_cast<int>(text.size())}, "an override reads key=value");
        return;
    }
    const std::string value = text.substr(equals + 1);
    std::string line = text;
    try {
        (void)toml::parse(std::string_view(line));
    } catch (const toml::parse_error&) {
        line = fmt::format("{}={}", text.substr(0, equals), write_value(node(std::string_view(value))));
    }
    overlay(root, loader.parse(line, std::string(override_source)), diagnostics);
}
} // namespace

const Node* Node::find(std::string_view key) const
{
    for (const Entry& entry : entries)
        if (entry.key == key) return &entry.value;
    return nullptr;
}

Node* Node::find(std::string_view key)
{
    return const_cast<Node*>(std::as_const(*this).find(key));
}

Node& Node::set(std::string_view key, Node value)
{
    if (Node* found = find(key)) return *found = std::move(value);
    entries.push_back({std::string(key), {}, std::move(value)});
    return entries.back().value;
}

Node node(bool value)
{
    Node out;
    out.kind = Node::Kind::boolean;
    out.boolean = value;
    return out;
}

Node node(std::int64_t value)
{
    Node out;
    out.kind = Node::Kind::integer;
    out.integer = value;
    return out;
}

Node node(Real value)
{
    Node out;
    out.kind = Node::Kind::real;
    out.real = value;
    return out;
}

Node node(std::string_view value)
{
    Node out;
    out.kind = Node::Kind::text;
    out.text = value;
    return out;
}

Node list_of(std::vector<Node> items)
{
    Node out;
    out.kind = Node::Kind::list;
    out.items = std::move(items);
    return out;
}

Node parse_value(std::string_view text)
{
    const std::string line = fmt::format("value={}", text);
    Node out = *converted(toml::parse(std::string_view(line)), -1).find("value");
    out.place = {};
    return out;
}

Node load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                   Diagnostics& diagnostics)
{
    const std::optional<std::string> text = file_text(file);
    if (!text)
        throw core::FileError(fmt::format("cannot read the case file '{}': {}", file.string(),
                                          std::filesystem::is_directory(file) ? "it is a directory"
                                          : std::filesystem::exists(file)     ? "no permission"
                                                                              : "no such file"));
    Loader loader(diagnostics);
    Node root = loader.load(file, *text);
    for (const std::string& line : overrides) apply_override(root, line, loader, diagnostics);
    return root;
}
} // namespace io
