#include "cli/options/refusal.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <vector>

#include "cli/options/splashsurf.hpp"
#include "meniscus/near_name.hpp"

namespace meniscus::cli {
namespace {

/// The option without what CLI11 takes for a part of it, such as "=3".
std::string option_name(const std::string& argument) {
    return argument.substr(0, argument.find('='));
}

bool is_option(const std::string& argument) {
    return argument.size() > 1 && argument[0] == '-' && std::isdigit(static_cast<unsigned char>(argument[1])) == 0;
}

std::string refuse_option(const CLI::App& command, const std::string& full_name, const std::string& option) {
    if (const std::string here = splashsurf_option(command.get_name(), option); !here.empty())
        return "unknown option " + option + ", which is splashsurf's: " + here;
    std::vector<std::string> names;
    for (const CLI::Option* known : command.get_options())
        names.insert(names.end(), known->get_lnames().begin(), known->get_lnames().end());
    const std::string near = near_name(option.substr(option.find_first_not_of('-')), names);
    return "unknown option " + option + suggestion(near.empty() ? "" : "--" + near, full_name + " --help");
}

std::string refuse_command(const CLI::App& app, const std::string& name) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (names.empty()) return "unexpected argument '" + name + "'; see " + app.get_name() + " --help";
    return "unknown command '" + name + "'" + suggestion(near_name(name, names), app.get_name() + " --help");
}

/// Of the commands that take sequences: a shell makes many arguments of frame_*.vtk.
std::string refuse_argument(const CLI::App& command, const std::string& full_name, const std::string& argument) {
    std::error_code none;
    const bool is_one_of_many =
        command.get_option_no_throw("--skip-missing") != nullptr && std::filesystem::is_regular_file(argument, none);
    return "unexpected argument '" + argument + "'; " +
           (is_one_of_many ? "a sequence is one argument with {} for the numbers, as 'frame_{}.vtk'"
                           : "see " + full_name + " --help");
}

}  // namespace

std::string refusal(const CLI::App& app, const CLI::ParseError& error) {
    const auto commands = app.get_subcommands();
    const CLI::App& command = commands.empty() ? app : *commands.front();
    const std::string full_name = commands.empty() ? app.get_name() : app.get_name() + " " + command.get_name();
    const std::vector<std::string> left = command.remaining();
    const auto option = std::find_if(left.begin(), left.end(), is_option);
    if (option != left.end() && *option != "--") return refuse_option(command, full_name, option_name(*option));
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || left.empty()) return error.what();
    if (commands.empty()) return refuse_command(app, left.front());
    return refuse_argument(command, full_name, left.front());
}

}  // namespace meniscus::cli
