// Examples below the options in --help.
#pragma once

#include <initializer_list>
#include <string_view>

namespace CLI {
class App;
}

namespace meniscus::cli {

/// Each is a line that can be pasted into a shell.
void add_examples(CLI::App& command, std::initializer_list<std::string_view> lines);

}  // namespace meniscus::cli
