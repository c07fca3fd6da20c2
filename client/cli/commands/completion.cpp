// meniscus completion: what a shell needs to complete this command line, made of the command line itself.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/completion_scripts.hpp"
#include "cli/commands/examples.hpp"
#include "cli/options/named_option.hpp"

namespace meniscus::cli {
namespace {

enum class Shell { bash, zsh };
constexpr std::string_view name_of(Shell shell) {
    switch (shell) {
        case Shell::bash:
            return "bash";
        case Shell::zsh:
            return "zsh";
    }
    return {};
}

/// The choices that CLI11 shows of an option, as {a,b,c}; none where there are none.
std::vector<std::string> choices_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t open = type.find('{');
    const std::size_t close = type.find('}', open);
    if (open == std::string::npos || close == std::string::npos) return {};
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

CompletedOption describe(const CLI::Option& option) {
    CompletedOption out;
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    out.description = option.get_description();
    out.values = option.get_type_size() == 0 ? 0 : static_cast<std::size_t>(option.get_expected_min());
    out.choices = choices_of(option);
    return out;
}

CompletedCommand describe(const CLI::App& command) {
    CompletedCommand out{command.get_name(), command.get_description(), {}, {}};
    for (const CLI::Option* option : command.get_options())
        (option->nonpositional() ? out.options : out.arguments).push_back(describe(*option));
    return out;
}

}  // namespace

void add_completion(CLI::App& app) {
    auto shell = std::make_shared<Shell>();
    CLI::App& command = *app.add_subcommand("completion", "Print the completion of this command line for a shell");
    add_named_option(command, "SHELL", *shell, "Whose")->required()->default_str("");
    add_examples(command, {"source <(meniscus completion bash)"});
    command.callback([&app, shell] {
        std::vector<CompletedCommand> commands;
        for (const CLI::App* of : app.get_subcommands({})) commands.push_back(describe(*of));
        const CompletedCommand program = describe(app);
        std::cout << (*shell == Shell::bash ? bash_completion(program, commands) : zsh_completion(program, commands));
    });
}

}  // namespace meniscus::cli
