// The settings of meniscusd: its command line, its environment, its file.
#pragma once

#include <optional>
#include <string>

#include "options/server_options.hpp"
#include "process/log.hpp"

namespace meniscus::server {

struct CommandLine {
    ServerOptions server;
    LogLevel log_level = LogLevel::info;
    LogFormat log_format = LogFormat::text;
    bool check_config = false;  ///< only report whether the settings can be used
};

/// What main() prints and returns where the server does not start.
struct EarlyExit {
    std::string text;
    int code = 0;
};

/// A flag counts more than the environment, which counts more than the file. Returns an exit where help, the version or
/// the settings are asked for, or a setting is wrong.
std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line);

}  // namespace meniscus::server
