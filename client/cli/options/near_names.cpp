#include "cli/options/near_names.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

namespace meniscus::cli {
namespace {

/// The least number of changes: the optimal string alignment distance.
std::size_t changes(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                least[i][j] = i + j;
                continue;
            }
            least[i][j] = std::min(
                {least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                least[i][j] = std::min(least[i][j], least[i - 2][j - 2] + 1);
        }
    return least[a.size()][b.size()];
}

/// The option without what CLI11 takes for a part of it, such as "=3".
std::string option_name(const std::string& argument) {
    return argument.substr(0, argument.find('='));
}

bool is_option(const std::string& argument) {
    return argument.size() > 1 && argument[0] == '-' && std::isdigit(static_cast<unsigned char>(argument[1])) == 0;
}

std::string refuse_option(const CLI::App& command, const std::string& full_name, const std::string& option) {
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

}  // namespace

std::string near_name(std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t shortest_beginning = 3;
    std::size_t least = 2 + name.size() / 4;
    std::string nearest;
    for (const std::string& candidate : names) {
        const bool begun = name.size() >= shortest_beginning && candidate.starts_with(name);
        const std::size_t count = begun ? 1 : changes(name, candidate);
        if (count < least) {
            least = count;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string suggestion(const std::string& near, const std::string& list) {
    return near.empty() ? "; see " + list : ", did you mean " + near + "?";
}

std::string refusal(const CLI::App& app, const CLI::ParseError& error) {
    const auto commands = app.get_subcommands();
    const CLI::App& command = commands.empty() ? app : *commands.front();
    const std::string full_name = commands.empty() ? app.get_name() : app.get_name() + " " + command.get_name();
    const std::vector<std::string> left = command.remaining();
    const auto option = std::find_if(left.begin(), left.end(), is_option);
    if (option != left.end() && *option != "--") return refuse_option(command, full_name, option_name(*option));
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || left.empty()) return error.what();
    if (commands.empty()) return refuse_command(app, left.front());
    return "unexpected argument '" + left.front() + "'; see " + full_name + " --help";
}

}  // namespace meniscus::cli
