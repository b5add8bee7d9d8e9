#include "io/study_sections.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
void for_each_table(Diagnostics& diagnostics, const Node* list, const std::string& name,
                    const std::function<void(const Node& item)>& visit)
{
    if (!list) return;
    if (list->kind != Node::Kind::list || list->items.empty()) {
        diagnostics.error(list->place, fmt::format("'{}' must be an array of tables", name),
                          fmt::format("write [[{}]]", name));
        return;
    }
    for (const Node& item : list->items) visit(item);
}

std::filesystem::path case_beside(SectionReader& section, const std::filesystem::path& file)
{
    const std::string name = section.text("case");
    const std::filesystem::path found = (file.parent_path() / name).lexically_normal();
    if (section.has("case") && !name.empty() && !std::filesystem::is_regular_file(found))
        section.error("case", fmt::format("there is no case file '{}'", found.string()), "relative to this file");
    return found;
}

std::vector<std::string> read_overrides(Diagnostics& diagnostics, SectionReader& section, std::string_view key)
{
    std::vector<std::string> set = section.names(key);
    const Node* written = section.find(key);
    for (std::size_t i = 0; written && i < written->items.size() && i < set.size(); ++i)
        if (const std::size_t equals = set[i].find('='); equals == std::string::npos || equals == 0)
            diagnostics.error(written->items[i].place, fmt::format("'{}' is no override", set[i]),
                              "expected key=value, such as \"grid.cell=0.5\"");
    return set;
}

void check_unique(Diagnostics& diagnostics, const Place& place, const std::string& kind, const std::string& name,
                  std::vector<std::string>& seen)
{
    if (!name.empty() && std::find(seen.begin(), seen.end(), name) != seen.end())
        diagnostics.error(place, fmt::format("there are two {}s '{}'", kind, name), "names must differ");
    seen.push_back(name);
}
} // namespace io
