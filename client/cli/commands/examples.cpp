#include "cli/commands/examples.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace meniscus::cli {

void add_examples(CLI::App& command, std::initializer_list<std::string_view> lines) {
    std::string text = "Examples:";
    for (const std::string_view line : lines) text.append("\n  ").append(line);
    command.footer(text);
}

}  // namespace meniscus::cli
