#include "security/trusted_peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

constexpr unsigned ipv4_bits = 32;
constexpr unsigned ipv6_bits = 128;

/// Whether the first bits of both are the same.
bool agree(const PeerAddress& a, const PeerAddress& b, unsigned bits) {
    for (unsigned i = 0; i < a.bytes().size() && bits > 8 * i; ++i) {
        const unsigned left = std::min(8U, bits - 8 * i);
        if (((a.bytes()[i] ^ b.bytes()[i]) >> (8U - left)) != 0) return false;
    }
    return true;
}

}  // namespace

TrustedPeers::TrustedPeers(const std::vector<std::string>& networks) {
    networks_.reserve(networks.size());
    for (const std::string& text : networks) networks_.push_back(parse(text));
}

TrustedPeers::Network TrustedPeers::parse(const std::string& text) {
    const std::size_t slash = text.find('/');
    const std::optional<PeerAddress> address = PeerAddress::parse(text.substr(0, slash));
    const unsigned all = address && address->is_ipv4() ? ipv4_bits : ipv6_bits;
    unsigned bits = all;
    bool is_number = true;
    if (slash != std::string::npos) {
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + slash + 1, end, bits);
        is_number = error == std::errc{} && rest == end;
    }
    if (!address || !is_number || bits > all)
        throw InvalidInput(
            fmt::format("--trusted-proxies {} is neither an address, such as 192.0.2.7 or 2001:db8::1, nor a network, "
                        "such as 10.0.0.0/8 or 2001:db8::/32",
                        text));
    return {.address = *address, .bits = ipv6_bits - all + bits};
}

bool TrustedPeers::is_exempt(const PeerAddress& peer) const noexcept {
    return peer.is_this_machine() || is_proxy(peer);
}

bool TrustedPeers::is_proxy(const PeerAddress& peer) const noexcept {
    return std::ranges::any_of(networks_,
                               [&peer](const Network& network) { return agree(network.address, peer, network.bits); });
}

}  // namespace meniscus::server
