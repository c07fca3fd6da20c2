// Whom a trusted proxy speaks for, by the header X-Forwarded-For.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "security/peer_address.hpp"
#include "security/trusted_peers.hpp"

namespace meniscus::server {

/// The client: of the addresses that the proxies have noted, the last one that is none of theirs. What is before it is
/// the client's own claim. None if the peer is no proxy of --trusted-proxies, or has noted no address. headers: the
/// values of the header, in their order; they may be anything.
std::optional<PeerAddress> forwarded_client(const TrustedPeers& trusted, const PeerAddress& peer,
                                            std::span<const std::string_view> headers);

}  // namespace meniscus::server
