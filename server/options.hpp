// The settings of meniscusd: its command line, its environment, its file.
#pragma once

#include <optional>
#include <string>

#include "log.hpp"
#include "server.hpp"

namespace meniscus::server {

struct CommandLine {
    ServerOptions server;
    LogLevel log_level = LogLevel::info;
    LogFormat log_format = LogFormat::text;
    bool check_config = false;  ///< only say whether the settings can be used
};

/// What main() is to print and to return with.
struct EarlyExit {
    std::string text;
    int code = 0;
};

/// A flag comes before the environment, and that before the file. Asked for help, its version or its settings, or told
/// something wrong, meniscusd does not start.
std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line);

}  // namespace meniscus::server
