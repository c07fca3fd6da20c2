// A duration as a flag of seconds.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <string>

namespace meniscus::cli {

/// value: to the nearest millisecond; outlives the parsing.
inline CLI::Option* add_seconds(CLI::App& command, const std::string& flag, std::chrono::milliseconds& value,
                                const std::string& description) {
    return command.add_option_function<double>(
        flag,
        [&value](double seconds) {
            value = std::chrono::round<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
        },
        description);
}

}  // namespace meniscus::cli
