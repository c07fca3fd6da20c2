#include "connections/received_bytes.hpp"

#include <linux/tcp.h>
#include <netinet/in.h>

#include <cstddef>
#include <utility>

#include "connections/descriptors.hpp"
#include "security/peer_address.hpp"

namespace meniscus::server {

namespace {

std::optional<std::uint64_t> received_by(int descriptor) {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (::getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return std::nullopt;
    // Linux before 4.1 does not have it.
    if (size < offsetof(tcp_info, tcpi_bytes_received) + sizeof info.tcpi_bytes_received) return std::nullopt;
    return info.tcpi_bytes_received;
}

}  // namespace

void ReceivedBytesOfPeers::enter(int descriptor, const sockaddr& peer) {
    if (peer.sa_family != AF_INET && peer.sa_family != AF_INET6) return;
    const in_port_t port = peer.sa_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(peer).sin6_port
                                                      : reinterpret_cast<const sockaddr_in&>(peer).sin_port;
    std::string name = PeerAddress(peer).text() + ' ' + std::to_string(ntohs(port));
    const std::lock_guard lock(mutex_);
    // The number is free again, so its connection is gone. The peer may have come again, by another one.
    std::string& before = names_[descriptor];
    const auto gone = connections_.find(before);
    if (gone != connections_.end() && gone->second.descriptor == descriptor) connections_.erase(gone);
    connections_[name] = {.descriptor = descriptor, .inode = inode_of(descriptor)};
    before = std::move(name);
}

std::function<std::optional<std::uint64_t>()> ReceivedBytesOfPeers::of(const std::string& peer) const {
    const std::string name = PeerAddress::of_grpc(peer).text() + ' ' + peer.substr(peer.rfind(':') + 1);
    const std::lock_guard lock(mutex_);
    const auto found = connections_.find(name);
    if (found == connections_.end()) return nullptr;
    return [connection = found->second]() -> std::optional<std::uint64_t> {
        if (inode_of(connection.descriptor) != connection.inode) return std::nullopt;
        return received_by(connection.descriptor);
    };
}

}  // namespace meniscus::server
