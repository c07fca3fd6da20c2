// Clients that come and go.
#pragma once

#include <cstdint>
#include <string>

namespace meniscus::soak {

/// So many connections, a few at a time, each on a socket of its own: most ask what the server is, some open a session,
/// stream a frame and leave without a word, some watch and break off. Throws what the first failure was.
void connect_many(const std::string& server, std::uint64_t connections);

}  // namespace meniscus::soak
