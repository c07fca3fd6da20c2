// Clients that come and go.
#pragma once

#include <cstdint>
#include <string>

namespace meniscus::soak {

/// Makes `connections`, a few at a time, each on a socket of its own: most ask for the server's information, some open
/// a session, stream a frame and leave without a word, some watch and break off. Throws the first failure.
void connect_many(const std::string& server, std::uint64_t connections);

}  // namespace meniscus::soak
