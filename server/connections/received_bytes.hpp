// The bytes that each connection has received, by the kernel's count.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace meniscus::server {

/// gRPC owns the connections' descriptors; see ConnectionTable. Thread-safe.
class ReceivedBytesOfPeers {
public:
    /// A connection that has come from this address. One of another family than IPv4 and IPv6 is not entered.
    void enter(int descriptor, const sockaddr& peer);
    /// Asks for the bytes of the connection that has this peer, in gRPC's words; they are none once it has gone. Empty
    /// if it was not entered.
    std::function<std::optional<std::uint64_t>()> of(const std::string& peer) const;

private:
    struct Connection {
        int descriptor = -1;
        ino_t inode = 0;
    };

    mutable std::mutex mutex_;
    std::unordered_map<std::string, Connection> connections_;  ///< by address and port
    std::unordered_map<int, std::string> names_;               ///< of those, by descriptor
};

}  // namespace meniscus::server
