// Scripts that let a shell complete a command line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace meniscus::cli {

struct CompletedOption {
    std::vector<std::string> names;  ///< with their dashes; none: an argument
    std::string description;
    std::size_t values = 0;            ///< 0: a flag
    std::vector<std::string> choices;  ///< of a value; empty: a file is offered
};

struct CompletedCommand {
    std::string name;
    std::string description;
    std::vector<CompletedOption> options;
    std::vector<CompletedOption> arguments;
};

/// program: the name, and the options that stand before a command.
std::string bash_completion(const CompletedCommand& program, const std::vector<CompletedCommand>& commands);
std::string zsh_completion(const CompletedCommand& program, const std::vector<CompletedCommand>& commands);

}  // namespace meniscus::cli
