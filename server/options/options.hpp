// The settings of meniscusd: its command line, its environment, its file.
#pragma once

#include <optional>
#include <string>

#include "meniscus/described.hpp"
#include "options/server_options.hpp"
#include "process/log.hpp"

namespace meniscus::server {

struct CommandLine {
    ServerOptions server;
    LogLevel log_level = LogLevel::info;
    LogFormat log_format = LogFormat::text;
    bool check_config = false;  ///< only report whether the settings can be used

    /// Calls visit for each setting, as ServerOptions::rows does.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        ServerOptions::rows(self.server, visit);
        visit("log_level", self.log_level, {.subject = "--log-level", .argument = "NAME"});
        visit("log_format", self.log_format,
              {.help = "text, or json: one object a line", .subject = "--log-format", .argument = "NAME"});
    }
};

/// The text that main() prints, and its exit code, where the server does not start.
struct EarlyExit {
    std::string text;
    int code = 0;
};

/// A flag counts more than the environment, which counts more than the file. Returns an exit where help, the version or
/// the settings are asked for, or a setting is wrong.
std::optional<EarlyExit> parse_command_line(int argc, const char* const* argv, CommandLine& command_line);

}  // namespace meniscus::server
