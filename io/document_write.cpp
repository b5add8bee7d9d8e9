#include "io/document.h"

#include <fmt/format.h>

namespace io
{
namespace
{
std::string in_quotes(std::string_view text)
{
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            (out += '\\') += c;
        else if (c == '\n')
            out += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + '"';
}

std::string written_key(std::string_view key)
{
    constexpr std::string_view bare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return !key.empty() && key.find_first_not_of(bare) == std::string_view::npos ? std::string(key) : in_quotes(key);
}

void write_table(const Node& table, const std::string& path, std::string& out);

void write_sections(const Entry& entry, const std::string& parent, std::string& out)
{
    const std::string path = parent.empty() ? written_key(entry.key) : parent + "." + written_key(entry.key);
    if (entry.value.kind == Node::Kind::list) {
        for (const Node& item : entry.value.items) {
            out += fmt::format("\n[[{}]]\n", path);
            write_table(item, path, out);
        }
        return;
    }
    bool holds_values = entry.value.entries.empty();
    for (const Entry& child : entry.value.entries) holds_values |= !child.value.section;
    if (holds_values) out += fmt::format("\n[{}]\n", path);
    write_table(entry.value, path, out);
}

void write_table(const Node& table, const std::string& path, std::string& out)
{
    for (const Entry& entry : table.entries)
        if (!entry.value.section) out += fmt::format("{} = {}\n", written_key(entry.key), write_value(entry.value));
    for (const Entry& entry : table.entries)
        if (entry.value.section) write_sections(entry, path, out);
}
} // namespace

std::string write_value(const Node& value)
{
    switch (value.kind) {
    case Node::Kind::boolean:
        return value.boolean ? "true" : "false";
    case Node::Kind::integer:
        return fmt::format("{}", value.integer);
    case Node::Kind::real:
        return fmt::format("{}", value.real);
    case Node::Kind::text:
        return in_quotes(value.text);
    case Node::Kind::list: {
        std::vector<std::string> items;
        for (const Node& item : value.items) items.push_back(write_value(item));
        return "[" + joined(items) + "]";
    }
    case Node::Kind::table: {
        std::vector<std::string> items;
        for (const Entry& entry : value.entries)
            items.push_back(fmt::format("{} = {}", written_key(entry.key), write_value(entry.value)));
        return items.empty() ? "{}" : "{ " + joined(items) + " }";
    }
    case Node::Kind::other:
        break;
    }
    return "\"\"";
}

std::string write_document(const Node& root)
{
    std::string out;
    write_table(root, "", out);
    return out;
}
} // namespace io
