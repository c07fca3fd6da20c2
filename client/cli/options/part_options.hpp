// The flags --parts, --part and --run, of what uploads a part of every frame.
#pragma once

#include "meniscus/client/client.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// server, session: the options that they need. session: null where part 0 may open the session of the others.
void add_part_options(CLI::App& command, client::StreamOptions& stream, CLI::Option& server, CLI::Option* session);

}  // namespace meniscus::cli
