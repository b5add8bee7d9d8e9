#include "io/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace io
{
namespace
{
constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

Node recorded(const Vec3& value)
{
    return list_of({node(value[0]), node(value[1]), node(value[2])});
}

Node recorded_axis(int axis)
{
    return node(std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1));
}
} // namespace

SectionReader::SectionReader(Diagnostics& diagnostics, const Node* table, std::string schema, std::string path,
                             const Place& place)
    : diagnostics_(diagnostics), table_(table), schema_(std::move(schema)), path_(std::move(path)),
      place_(table ? table->place : place), errors_before_(diagnostics.error_count())
{
    resolved_.section = true;
    if (table_ && table_->kind != Node::Kind::table) {
        diagnostics_.error(table_->place, fmt::format("'{}' must be a table", path_));
        table_ = nullptr;
    }
}

const Place& SectionReader::place(std::string_view name) const
{
    const Node* found = find(name);
    return found ? found->place : place_;
}

const Node* SectionReader::value(const Key& key)
{
    if (const Node* found = find(key.name)) return found;
    if (key.presence == Presence::defaulted) {
        fallback_ = parse_value(key.fallback);
        return &fallback_;
    }
    if (key.presence == Presence::required)
        diagnostics_.error(place_,
                           path_.empty() ? fmt::format("missing key '{}'", key.name)
                                         : fmt::format("missing key '{}' in [{}]", key.name, path_),
                           fmt::format("expected {} = {}: {}", key.name, expected(key), key.meaning));
    return nullptr;
}

bool SectionReader::boolean(std::string_view name)
{
    return boolean(name, false);
}

bool SectionReader::boolean(std::string_view name, bool fallback)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    bool out = fallback;
    if (found && found->kind != Node::Kind::boolean)
        type_error(*found, wanted, diagnostics_);
    else if (found)
        out = found->boolean;
    record(name, node(out));
    return out;
}

std::optional<std::int64_t> SectionReader::optional_integer(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    if (!found) return std::nullopt;
    if (found->kind != Node::Kind::integer) {
        type_error(*found, wanted, diagnostics_);
        return std::nullopt;
    }
    if (!in_range(static_cast<Real>(found->integer), wanted.range)) {
        diagnostics_.error(found->place, fmt::format("'{}' is out of range: {}", name, found->integer),
                           fmt::format("expected {}", expected(wanted)));
        return std::nullopt;
    }
    record(name, node(found->integer));
    return found->integer;
}

int SectionReader::integer(std::string_view name)
{
    const std::int64_t value = optional_integer(name).value_or(1);
    if (std::abs(value) <= std::numeric_limits<int>::max()) return static_cast<int>(value);
    error(name, fmt::format("'{}' is out of range: {}", name, value),
          fmt::format("at most {}", std::numeric_limits<int>::max()));
    return 1;
}

std::optional<Real> SectionReader::optional_real(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    if (!found) return std::nullopt;
    const std::optional<Real> read = read_real(*found, wanted, diagnostics_);
    if (read && wanted.type == Type::wall_time)
        record(name, node(fmt::format("{} s", *read)));
    else if (read)
        record(name, node(*read));
    return read;
}

Real SectionReader::real(std::string_view name)
{
    return optional_real(name).value_or(nan);
}

Real SectionReader::real(std::string_view name, Real fallback)
{
    if (has(name)) return real(name);
    record(name, node(fallback));
    return fallback;
}

std::optional<std::string> SectionReader::optional_text(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    if (!found) return std::nullopt;
    const std::optional<std::string> read = read_text(*found, wanted, diagnostics_);
    if (read) record(name, node(std::string_view(*read)));
    return read;
}

std::string SectionReader::text(std::string_view name)
{
    return optional_text(name).value_or("");
}

std::size_t SectionReader::choice_index(std::string_view name, std::size_t fallback)
{
    const Key& wanted = key(name);
    const std::vector<std::string> choices = choices_of(wanted);
    const Node* found = value(wanted);
    std::size_t index = fallback;
    if (found)
        if (const std::optional<std::string> read = read_text(*found, wanted, diagnostics_)) {
            const auto match = std::find(choices.begin(), choices.end(), *read);
            index = match == choices.end() ? fallback : static_cast<std::size_t>(match - choices.begin());
            const std::string hint = nearest_hint(*read, choices);
            if (match == choices.end())
                diagnostics_.error(found->place, fmt::format("'{}' is not a value of '{}'", *read, name),
                                   hint.empty() ? fmt::format("expected {}", expected(wanted)) : hint,
                                   {fmt::format("values: {}", joined(choices))});
        }
    record(name, node(std::string_view(choices[index])));
    return index;
}

std::string SectionReader::choice_name(std::string_view name)
{
    return choices_of(key(name))[choice_index(name, 0)];
}

std::optional<int> SectionReader::optional_axis(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    if (!found) return std::nullopt;
    const std::optional<int> read = read_axis(*found, wanted, diagnostics_);
    if (read) record(name, recorded_axis(*read));
    return read;
}

int SectionReader::axis(std::string_view name)
{
    return optional_axis(name).value_or(0);
}

std::optional<Vec3> SectionReader::optional_vector(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    if (!found) return std::nullopt;
    const std::optional<Vec3> read = read_vector(*found, wanted, diagnostics_);
    if (read) record(name, recorded(*read));
    return read;
}

Vec3 SectionReader::vector(std::string_view name)
{
    return optional_vector(name).value_or(Vec3::Constant(nan));
}

std::vector<std::string> SectionReader::names(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    std::vector<std::string> out;
    if (!found) return out;
    if (found->kind != Node::Kind::list) type_error(*found, wanted, diagnostics_);
    const std::vector<std::string> choices = choices_of(wanted);
    std::vector<Node> items;
    for (const Node& item : found->items)
        if (const std::optional<std::string> read = read_text(item, wanted, diagnostics_)) {
            if (!choices.empty() && std::find(choices.begin(), choices.end(), *read) == choices.end())
                diagnostics_.error(item.place, fmt::format("'{}' is not a value of '{}'", *read, name), "",
                                   {fmt::format("values: {}", joined(choices))});
            out.push_back(*read);
            items.push_back(node(std::string_view(*read)));
        }
    record(name, list_of(std::move(items)));
    return out;
}

std::vector<std::string> SectionReader::distinct_names(std::string_view name)
{
    std::vector<std::string> out = names(name), seen;
    const Node* found = find(name);
    for (std::size_t i = 0; found && i < found->items.size(); ++i) {
        const Node& item = found->items[i];
        if (item.kind != Node::Kind::text) continue;
        if (std::find(seen.begin(), seen.end(), item.text) != seen.end())
            diagnostics_.error(item.place, fmt::format("'{}' stands twice in '{}'", item.text, name));
        seen.push_back(item.text);
    }
    return out;
}

std::vector<Vec3> SectionReader::points(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    std::vector<Vec3> out;
    if (!found) return out;
    if (found->kind != Node::Kind::list || found->items.empty()) type_error(*found, wanted, diagnostics_);
    std::vector<Node> items;
    for (const Node& item : found->items)
        if (const std::optional<Vec3> read = read_vector(item, wanted, diagnostics_)) {
            out.push_back(*read);
            items.push_back(recorded(*read));
        }
    record(name, list_of(std::move(items)));
    return out;
}

std::vector<Pair> SectionReader::corners(std::string_view name)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    std::vector<Pair> out;
    if (!found) return out;
    if (found->kind != Node::Kind::list || found->items.size() < 3) type_error(*found, wanted, diagnostics_);
    Key component = wanted;
    component.type = Type::real;
    std::vector<Node> items;
    for (const Node& item : found->items) {
        if (item.kind != Node::Kind::list || item.items.size() != 2) {
            type_error(item, wanted, diagnostics_);
            continue;
        }
        const std::optional<Real> first = read_real(item.items[0], component, diagnostics_);
        const std::optional<Real> second = read_real(item.items[1], component, diagnostics_);
        if (!first || !second) continue;
        out.push_back({*first, *second});
        items.push_back(list_of({node(*first), node(*second)}));
    }
    record(name, list_of(std::move(items)));
    return out;
}

FreeVector SectionReader::velocity(std::string_view name, std::optional<int> axis)
{
    const Key& wanted = key(name);
    const Node* found = value(wanted);
    FreeVector out;
    if (!found) return out;
    Key component = wanted;
    component.type = Type::real;
    if (found->kind == Node::Kind::list) {
        if (found->items.size() != 3) type_error(*found, wanted, diagnostics_);
        if (axis) error("axis", "'axis' goes with a single velocity, not with three components");
        for (std::size_t a = 0; a < std::min<std::size_t>(3, found->items.size()); ++a)
            if (const Node& item = found->items[a]; item.kind != Node::Kind::text || item.text != "free")
                out[a] = read_real(item, component, diagnostics_);
    } else if (axis)
        out[static_cast<std::size_t>(*axis)] = read_real(*found, component, diagnostics_);
    else if (!has("axis")) // a wrong one has its complaint
        diagnostics_.error(found->place, fmt::format("a single velocity in [{}] needs a direction", path_),
                           "add axis = \"x\", \"y\" or \"z\", or write three components");
    std::vector<Node> items;
    for (const std::optional<Real>& speed : out) items.push_back(speed ? node(*speed) : node(std::string_view("free")));
    if (axis && found->kind != Node::Kind::list)
        record(name, items[static_cast<std::size_t>(*axis)]);
    else
        record(name, list_of(std::move(items)));
    return out;
}

void SectionReader::error(std::string_view name, std::string message, std::string beside)
{
    diagnostics_.error(place(name), std::move(message), std::move(beside));
}

void SectionReader::record(std::string_view name, const SectionReader& own)
{
    Node table = own.resolved();
    table.section = false;
    record(name, std::move(table));
}

void SectionReader::finish()
{
    if (!table_) return;
    std::vector<std::string> known;
    for (const Key* candidate : keys_of(schema_)) known.emplace_back(candidate->name);
    for (const Entry& entry : table_->entries) {
        if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
        std::vector<std::string> sorted = known;
        std::sort(sorted.begin(), sorted.end());
        diagnostics_.key_error(
            entry.place,
            fmt::format("unknown key '{}' {}", entry.key,
                        !path_.empty()    ? fmt::format("in [{}]", path_)
                        : schema_.empty() ? "at the top of the case"
                                          : "at the top of the file"),
            nearest_hint(entry.key, known),
            {fmt::format("keys here: {}     (cleave keys {})", joined(sorted), schema_.empty() ? "case" : schema_)});
    }
}
} // namespace io
