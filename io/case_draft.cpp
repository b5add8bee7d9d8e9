#include "io/case_draft.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
/// The value at a path of names; the tables that lead to it are created on the way, it itself is `fresh` if new.
Node& reach(Node& root, const std::vector<std::string>& path, Node fresh)
{
    Node* place = &root;
    for (std::size_t i = 0; i < path.size(); ++i) {
        Node* next = place->find(path[i]);
        if (!next) {
            next = &place->set(path[i], i + 1 == path.size() ? std::move(fresh) : Node{});
            next->section = true;
        }
        place = next;
    }
    return *place;
}

template <class Part>
const Part* find_named(Draft& draft, const std::vector<Part>& parts, std::string_view kind, const std::string& name,
                       const Place& place)
{
    std::vector<std::string> names;
    for (const Part& part : parts) {
        if (part.name == name) return &part;
        names.push_back(part.name);
    }
    unknown_name(draft, place, kind, name, names);
    return nullptr;
}
} // namespace

const solver::Feature* find_feature(Draft& draft, const std::string& name, const Place& place)
{
    return find_named(draft, draft.problem.features, "feature", name, place);
}

const material::Material* find_material(Draft& draft, const std::string& name, const Place& place)
{
    return find_named(draft, draft.problem.materials, "material", name, place);
}

int material_index(Draft& draft, const std::string& name, const Place& place)
{
    const material::Material* found = find_material(draft, name, place);
    return found ? static_cast<int>(found - draft.problem.materials.data()) : 0;
}

void unknown_name(Draft& draft, const Place& place, std::string_view kind, std::string_view name,
                  const std::vector<std::string>& candidates)
{
    draft.diagnostics.error(place, fmt::format("there is no {} '{}'", kind, name), nearest_hint(name, candidates),
                            {candidates.empty() ? fmt::format("the case has no {}s", kind)
                                                : fmt::format("{}s here: {}", kind, joined(candidates))});
}

void for_each_item(Draft& draft, const Node* list, const std::string& name,
                   const std::function<void(const Node& item)>& visit)
{
    if (!list) return;
    if (list->kind != Node::Kind::list) {
        draft.diagnostics.error(list->place, fmt::format("'{}' must be an array of tables", name),
                                fmt::format("write [[{}]]", name));
        return;
    }
    for (const Node& item : list->items) visit(item);
}

void for_each_named(Draft& draft, const Node& table, std::string_view kind,
                    const std::function<void(const Entry& entry)>& read)
{
    // Begun by a dotted key: one that an override writes as a whole, { ... }, is meant to be new.
    const auto begun = [&](const Entry& entry) {
        return draft.diagnostics.source_name(entry.place) == override_source && entry.value.section;
    };
    std::vector<std::string> names;
    for (const Entry& entry : table.entries)
        if (!begun(entry)) names.push_back(entry.key);
    for (const Entry& entry : table.entries) {
        const std::size_t before = draft.diagnostics.error_count();
        read(entry);
        if (draft.diagnostics.error_count() == before || names.empty() || !begun(entry)) continue;
        draft.diagnostics.forget_errors(before);
        draft.diagnostics.key_error(entry.place, fmt::format("there is no {} '{}'", kind, entry.key),
                                    nearest_hint(entry.key, names),
                                    {fmt::format("{}s here: {}; a new one needs more keys", kind, joined(names))});
    }
}

void keep(Draft& draft, const std::vector<std::string>& path, Node section)
{
    reach(draft.resolved, path, {}) = std::move(section);
}

void keep_item(Draft& draft, const std::vector<std::string>& path, Node section)
{
    reach(draft.resolved, path, list_of({})).items.push_back(std::move(section));
}
} // namespace io
