// Which session a user means.
#pragma once

#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::cli {

/// Its id: the text itself where it has the form of one, otherwise that of the only session with this name, of those
/// that the caller sees. Throws InvalidInput if there is none, or several, which it names by their ids.
std::string session_id_of(client::Client& client, const std::string& id_or_name);

}  // namespace meniscus::cli
