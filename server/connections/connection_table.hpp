// Which connections the gRPC port has, of whom, and whether one more may come.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <unordered_map>
#include <utility>

#include "security/peer_address.hpp"
#include "security/trusted_peers.hpp"

namespace meniscus::server {

struct ConnectionLimits {
    std::size_t all = 0;            ///< 0: no limit
    std::size_t for_each_peer = 0;  ///< loopback, Unix sockets and trusted proxies excepted; 0: no limit
};

/// gRPC owns its connections' descriptors and closes them without notice. A descriptor's file is known again by
/// its inode: where it is another, or none, the connection is gone. That is looked up only where a limit is reached. Of
/// one thread at a time.
class ConnectionTable {
public:
    using Clock = std::chrono::steady_clock;
    enum class Verdict { admitted, too_many, too_many_of_peer };

    ConnectionTable(const ConnectionLimits& limits, TrustedPeers trusted)
        : limits_(limits), trusted_(std::move(trusted)) {}

    /// Enters the connection if it is admitted.
    Verdict admit(int descriptor, const PeerAddress& peer);
    const ConnectionLimits& limits() const noexcept { return limits_; }

    /// Looks up which connections are gone. Returns the number of those that are left.
    std::size_t sweep();

private:
    struct Connection {
        ino_t inode = 0;
        PeerAddress share;
    };

    using Connections = std::unordered_map<int, Connection>;

    bool is_full() const;
    bool is_full_for(const PeerAddress& peer) const;
    Connections::iterator remove(Connections::iterator connection);

    const ConnectionLimits limits_;
    const TrustedPeers trusted_;
    Connections connections_;  ///< by descriptor
    std::map<PeerAddress, std::size_t> of_peers_;
    Clock::time_point swept_at_{};
};

}  // namespace meniscus::server
