#include "connections/own_connections.hpp"

#include <netinet/in.h>

#include "security/peer_address.hpp"

namespace meniscus::server {

namespace {

/// A key of an address: equal at both ends of a connection, also where an IPv4 client meets a socket of IPv6.
std::string key_of(const sockaddr& address, socklen_t size) {
    if (address.sa_family == AF_UNIX) return {reinterpret_cast<const char*>(&address), size};
    const in_port_t port = address.sa_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                                         : reinterpret_cast<const sockaddr_in&>(address).sin_port;
    return PeerAddress(address).text() + ' ' + std::to_string(port);
}

}  // namespace

void OwnConnections::expect(const sockaddr& address, socklen_t size) {
    const std::lock_guard lock(mutex_);
    expected_.insert(key_of(address, size));
}

void OwnConnections::forget(const sockaddr& address, socklen_t size) {
    const std::lock_guard lock(mutex_);
    expected_.erase(key_of(address, size));
}

bool OwnConnections::includes(const sockaddr& address, socklen_t size) const {
    const std::lock_guard lock(mutex_);
    return !expected_.empty() && expected_.contains(key_of(address, size));
}

}  // namespace meniscus::server
