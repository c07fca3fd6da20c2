// What is said of arguments that are wrong.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace meniscus::cli {

/// The error in the arguments, in one line. An option or a command that does not exist comes first, since other errors
/// may follow from it.
std::string refusal(const CLI::App& app, const CLI::ParseError& error);

}  // namespace meniscus::cli
