// The command line of meniscusd.
#pragma once

#include <spdlog/common.h>

#include <optional>
#include <string>

#include "server.hpp"

namespace meniscus::server {

struct CommandLine {
    ServerOptions server;
    spdlog::level::level_enum log_level = spdlog::level::info;
};

/// What main() is to print and to return with.
struct EarlyExit {
    std::string text;
    int code = 0;
};

/// Asked for help or its version, or told something wrong, meniscusd does not start.
std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line);

}  // namespace meniscus::server
