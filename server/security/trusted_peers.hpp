// Which peers have no limits of their own, since more than one client speaks through them.
#pragma once

#include <string>
#include <vector>

#include "security/peer_address.hpp"

namespace meniscus::server {

/// Loopback, Unix sockets and the networks of --trusted-proxies. Immutable, hence thread-safe.
class TrustedPeers {
public:
    /// networks: addresses such as "192.0.2.7" and "2001:db8::1", or networks such as "10.0.0.0/8". Throws InvalidInput
    /// that names the one that is neither.
    explicit TrustedPeers(const std::vector<std::string>& networks = {});

    /// Whether limits for each peer address do not hold for this one.
    bool is_exempt(const PeerAddress& peer) const noexcept;
    /// Whether its word about others counts: of --trusted-proxies alone. Any program of this machine may connect by
    /// loopback.
    bool is_proxy(const PeerAddress& peer) const noexcept;

private:
    struct Network {
        PeerAddress address;
        unsigned bits = 128;  ///< of the address as IPv6
    };
    static Network parse(const std::string& text);

    std::vector<Network> networks_;
};

}  // namespace meniscus::server
