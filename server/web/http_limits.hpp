// The limits of HTTP clients.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace meniscus::server {

struct HttpLimits {
    /// Beyond it, a new connection takes the place of the one that has been silent longest and carries no stream.
    std::size_t connections = 512;
    /// Connections of one address. Beyond it, its own make room in the same way; 0: no such limit.
    std::size_t connections_per_peer = 0;
    std::size_t streams = 384;          ///< fewer than connections, so that there is always room for probes
    std::uint32_t header_bytes = 8192;  ///< of the request line, and of all fields
    std::uint32_t body_bytes = 65536;   ///< of a gRPC-Web request, in at most body_chunks chunks
    std::uint32_t body_chunks = 64;
    /// For a whole request to come, and for an answer to be taken, which has more time the larger it is, if some of it
    /// is taken within each such time.
    std::chrono::milliseconds patience = std::chrono::seconds(30);
    std::uint32_t bytes_per_second = 64 << 10;  ///< with which an answer is taken beyond that
};

}  // namespace meniscus::server
