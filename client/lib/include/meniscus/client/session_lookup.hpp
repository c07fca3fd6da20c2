// Which session a user means.
#pragma once

#include <stop_token>
#include <string>

#include "meniscus/client/client.hpp"

namespace meniscus::client {

/// Its id: the text itself where it has the form of one, otherwise that of the only session with this name, of those
/// that the caller sees. Throws InvalidInput if there is none, naming those that there are, or several, which it names
/// by their ids; ServerError.
std::string session_id_of(Client& client, const std::string& id_or_name, const std::stop_token& stop = {});
/// Likewise of the sessions whose recordings the server has.
std::string recorded_session_id_of(Client& client, const std::string& id_or_name, const std::stop_token& stop = {});

}  // namespace meniscus::client
