/// `cleave new NAME`: a commented case to start from.
#include "app/commands.h"
#include "app/template.h"
#include "core/error.h"
#include "io/atomic_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace app
{
namespace
{
int write_new_case(std::string name)
{
    std::filesystem::path file = name;
    if (file.stem().empty()) throw core::InputError(fmt::format("'{}' is no name for a case", name));
    if (file.extension() != ".toml") file += ".toml";
    if (std::filesystem::exists(file))
        throw core::FileError(fmt::format("'{}' exists already: choose another name", file.string()));
    io::write_file(file, case_template(file.stem().string()));
    fmt::print("wrote {0}; next: cleave check {0}\n", file.string());
    return 0;
}
} // namespace

void add_new(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("new", "Write a commented case to start from");
    const auto name = std::make_shared<std::string>();
    command->add_option("NAME", *name, "name of the case, with or without .toml")->required();
    command->callback([&chosen, name] { chosen = [name] { return write_new_case(*name); }; });
}
} // namespace app
