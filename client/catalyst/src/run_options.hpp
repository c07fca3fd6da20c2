// The options of a run: those of the C interface by their names, which server or folder and which channel.
#pragma once

#include <string>
#include <vector>

#include "node.hpp"
#include "notices.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::catalyst {

struct RunOptions {
    std::string server;           ///< HOST:PORT and so on, as meniscus_client_connect() takes it
    std::string output;           ///< a folder for files of surfaces, in place of the server
    std::string channel;          ///< the one whose particles are taken; empty: the first that has a mesh
    bool makes_surfaces = false;  ///< the ranks, by option reconstruct-ranks or output; otherwise the server
    text_options::Options connection;
    text_options::Options session;
    bool all_attributes = false;
    std::vector<std::string> attributes;  ///< those that the session's settings name
};

/// From catalyst/scripts/NAME/args, where an unknown name is said and passed over, since scripts have other readers,
/// too; and over those from `environment`, the value of MENISCUS_CATALYST, where it is refused. A word without =
/// belongs to the value before it. Throws InvalidInput.
RunOptions read_run_options(const Node& params, const char* environment, Notices& notices);

}  // namespace meniscus::catalyst
