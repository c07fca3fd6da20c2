// A duration as a flag of seconds.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <sstream>
#include <string>

#include "meniscus/seconds.hpp"

namespace meniscus::cli {

/// value: to the nearest millisecond; outlives the parsing.
inline CLI::Option* add_seconds(CLI::App& command, const std::string& flag, std::chrono::milliseconds& value,
                                const std::string& description) {
    CLI::Option* const option = command.add_option_function<double>(
        flag, [&value](double seconds) { value = milliseconds_of(seconds); }, description);
    if (command.option_defaults()->get_always_capture_default()) {
        std::ostringstream present;
        present << seconds_of(value);
        option->default_str(present.str());
    }
    return option;
}

}  // namespace meniscus::cli
