#include "connections/connection_table.hpp"

#include "connections/descriptors.hpp"

namespace meniscus::server {

namespace {

/// A look at thousands of connections takes a millisecond: not for each of the thousands that a full port refuses.
constexpr auto sweep_gap = std::chrono::milliseconds(20);

}  // namespace

ConnectionTable::Verdict ConnectionTable::admit(int descriptor, const PeerAddress& peer) {
    const PeerAddress share = peer.share();
    // The number is free again, so its connection is gone.
    if (const auto before = connections_.find(descriptor); before != connections_.end()) remove(before);
    if (is_full() || is_full_for(peer)) {
        if (Clock::now() - swept_at_ >= sweep_gap) sweep();
        if (is_full()) return Verdict::too_many;
        if (is_full_for(peer)) return Verdict::too_many_of_peer;
    }
    connections_.emplace(descriptor, Connection{.inode = inode_of(descriptor), .share = share});
    ++of_peers_[share];
    return Verdict::admitted;
}

bool ConnectionTable::is_full() const {
    return limits_.all != 0 && connections_.size() >= limits_.all;
}

bool ConnectionTable::is_full_for(const PeerAddress& peer) const {
    if (limits_.for_each_peer == 0 || trusted_.is_exempt(peer)) return false;
    const auto found = of_peers_.find(peer.share());
    return found != of_peers_.end() && found->second >= limits_.for_each_peer;
}

std::size_t ConnectionTable::sweep() {
    for (auto connection = connections_.begin(); connection != connections_.end();)
        connection =
            inode_of(connection->first) == connection->second.inode ? std::next(connection) : remove(connection);
    swept_at_ = Clock::now();
    return connections_.size();
}

ConnectionTable::Connections::iterator ConnectionTable::remove(Connections::iterator connection) {
    const auto of_peer = of_peers_.find(connection->second.share);
    if (--of_peer->second == 0) of_peers_.erase(of_peer);
    return connections_.erase(connection);
}

}  // namespace meniscus::server
