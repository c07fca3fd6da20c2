// meniscus help: what --help says.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/examples.hpp"
#include "meniscus/error.hpp"
#include "meniscus/near_name.hpp"

namespace meniscus::cli {
namespace {

void help(CLI::App& app, const std::string& name) {
    if (name.empty()) {
        // That of the App itself would be the help of the command that is parsed, which is this one.
        std::cout << app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
        return;
    }
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw InvalidInput("unknown command '" + name + "'" +
                           suggestion(near_name(name, names), app.get_name() + " --help"));
    std::cout << app.get_subcommand(name)->help(app.get_name());
}

}  // namespace

void add_help(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    CLI::App& command = *app.add_subcommand("help", "Explain a command, or list them all");
    std::string names;
    for (const CLI::App* known : app.get_subcommands({})) names += (names.empty() ? "" : ",") + known->get_name();
    command.add_option("COMMAND", *name, "The command to explain")->type_name("{" + names + "}");
    add_examples(command, {"meniscus help reconstruct"});
    command.callback([&app, name] { help(app, *name); });
}

}  // namespace meniscus::cli
