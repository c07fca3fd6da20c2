// The flags that say which session to open on a server, and what people call it.
#pragma once

#include <string>
#include <vector>

#include "meniscus/client/client.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace meniscus::cli {

/// --name, --up-axis and --length-unit. when: stands before what --help says of them. description: outlives the
/// parsing.
std::vector<CLI::Option*> add_description_flags(CLI::App& command, client::SessionDescription& description,
                                                const std::string& when);

/// --session, --name, --up-axis, --length-unit, --keep-session and --publish.
struct SessionFlags {
    std::string id;  ///< empty: a new one
    client::SessionDescription description;
    bool keep = false;
    bool publish = false;

    /// server: the option that they need.
    void add_to(CLI::App& command, CLI::Option& server);
    /// With the name, the axis and the unit of a recording's session where they are not given.
    SessionFlags over(const client::SessionDescription& recorded) const;
};

}  // namespace meniscus::cli
