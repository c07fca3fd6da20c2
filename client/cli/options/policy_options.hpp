// The flags --policy, --nth and --reconnect, of whatever uploads.
#pragma once

#include "meniscus/client/client.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// --policy and --nth. Returns --policy, so that the command can say which flags it requires.
CLI::Option* add_policy_options(CLI::App& command, client::StreamOptions& stream);

/// All three, of a command with a session on a server. server: the option that they need.
void add_stream_options(CLI::App& command, client::StreamOptions& stream, CLI::Option& server);

}  // namespace meniscus::cli
