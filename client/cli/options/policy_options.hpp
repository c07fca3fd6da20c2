// The flags --policy and --nth, of whatever uploads.
#pragma once

#include "meniscus/client/client.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// Returns --policy, so that the command can say which flags it requires.
CLI::Option* add_policy_options(CLI::App& command, client::StreamOptions& stream);

}  // namespace meniscus::cli
