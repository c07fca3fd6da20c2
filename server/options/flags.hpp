// The flags of meniscusd: one for each row of its options.
#pragma once

#include "options/options.hpp"

namespace CLI {
class App;
}

namespace meniscus::server {

/// The flags set the members. They have the members' values as defaults, in the order of the rows.
void add_flags(CLI::App& app, CommandLine& command_line);

/// After all sources were read: members that nobody has set, and whose default follows from others, get it.
void set_defaults_that_follow(const CLI::App& app, CommandLine& command_line);

}  // namespace meniscus::server
