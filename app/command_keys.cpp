/// `cleave keys [SECTION]`: what case, suite and sweep files may hold.
#include "app/commands.h"
#include "core/error.h"
#include "io/diagnostics.h"
#include "io/keys.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace app
{
namespace
{
/// The top of a case has no section name; users call it "case".
std::string shown_name(const std::string& section)
{
    return section.empty() ? "case" : section;
}

std::string shown_default(const io::Key& key)
{
    switch (key.presence) {
    case io::Presence::required:
        return "required";
    case io::Presence::defaulted:
        return fmt::format("default {}", key.fallback);
    case io::Presence::optional:
        break;
    }
    return "optional";
}

void print_section(const std::string& section)
{
    fmt::print("[{}]\n", shown_name(section));
    for (const io::Key* key : io::keys_of(section)) {
        fmt::print("  {:<20} {}; {}\n", key->name, io::expected(*key), shown_default(*key));
        fmt::print("  {:<20} {}\n", "", key->meaning);
    }
}

/// Sections a word names: exactly, or as the beginning of their names ("output" names all of them).
std::vector<std::string> sections_named(const std::string& wanted)
{
    std::vector<std::string> found;
    std::vector<std::string> all = io::section_names();
    const std::vector<std::string> study = io::study_section_names();
    all.insert(all.end(), study.begin(), study.end());
    for (const std::string& section : all)
        if (wanted.empty() || shown_name(section) == wanted || section.rfind(wanted + ".", 0) == 0)
            found.push_back(section);
    if (found.empty()) {
        std::vector<std::string> names;
        for (const std::string& section : all) names.push_back(shown_name(section));
        throw core::InputError(fmt::format("there is no section '{}'{}\nsections: {}", wanted,
                                           io::nearest_hint(wanted, names, "; "), io::joined(names)));
    }
    return found;
}
} // namespace

void add_keys(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("keys", "Every key of case, suite and sweep files: type, unit, default, meaning");
    const auto section = std::make_shared<std::string>();
    command->add_option("SECTION", *section, "only this section, such as material.decohesion");
    command->callback([&chosen, section] {
        chosen = [section] {
            for (const std::string& name : sections_named(*section)) print_section(name);
            return 0;
        };
    });
}
} // namespace app
