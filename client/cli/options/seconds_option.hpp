// A duration as a flag of seconds.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <sstream>
#include <string>

namespace meniscus::cli {

/// value: to the nearest millisecond; outlives the parsing.
inline CLI::Option* add_seconds(CLI::App& command, const std::string& flag, std::chrono::milliseconds& value,
                                const std::string& description) {
    CLI::Option* const option = command.add_option_function<double>(
        flag,
        [&value](double seconds) {
            value = std::chrono::round<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
        },
        description);
    if (command.option_defaults()->get_always_capture_default()) {
        std::ostringstream present;
        present << std::chrono::duration<double>(value).count();
        option->default_str(present.str());
    }
    return option;
}

}  // namespace meniscus::cli
