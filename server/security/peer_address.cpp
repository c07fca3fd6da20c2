#include "security/peer_address.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstring>

namespace meniscus::server {

namespace {

/// The first bytes of an IPv4 address as IPv6.
constexpr std::array<unsigned char, 12> mapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
constexpr std::size_t network_bytes = 8;

}  // namespace

PeerAddress::PeerAddress(const sockaddr& address) {
    if (address.sa_family == AF_INET) {
        std::ranges::copy(mapped, bytes_.begin());
        std::memcpy(bytes_.data() + mapped.size(), &reinterpret_cast<const sockaddr_in&>(address).sin_addr, 4);
    } else if (address.sa_family == AF_INET6) {
        std::memcpy(bytes_.data(), &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, bytes_.size());
    }
}

PeerAddress PeerAddress::of_grpc(std::string_view peer) {
    const std::size_t scheme = peer.find(':');
    const std::size_t port = peer.rfind(':');
    if (scheme == std::string_view::npos || port <= scheme) return {};
    std::string_view host = peer.substr(scheme + 1, port - scheme - 1);
    const auto unwrap = [&host](std::string_view before, std::string_view after) {
        if (!host.starts_with(before) || !host.ends_with(after)) return;
        host.remove_prefix(before.size());
        host.remove_suffix(after.size());
    };
    unwrap("%5B", "%5D");
    unwrap("[", "]");
    // A zone, as of fe80::1%25eth0, is part of the way there, not of the address.
    return parse(std::string(host.substr(0, host.find('%')))).value_or(PeerAddress{});
}

std::optional<PeerAddress> PeerAddress::parse(const std::string& text) {
    sockaddr_in ipv4{};
    ipv4.sin_family = AF_INET;
    if (::inet_pton(AF_INET, text.c_str(), &ipv4.sin_addr) == 1)
        return PeerAddress(reinterpret_cast<const sockaddr&>(ipv4));
    sockaddr_in6 ipv6{};
    ipv6.sin6_family = AF_INET6;
    if (::inet_pton(AF_INET6, text.c_str(), &ipv6.sin6_addr) == 1)
        return PeerAddress(reinterpret_cast<const sockaddr&>(ipv6));
    return std::nullopt;
}

bool PeerAddress::is_this_machine() const noexcept {
    if (is_ipv4()) return bytes_[mapped.size()] == 127;
    return bytes_.back() <= 1 && std::all_of(bytes_.begin(), bytes_.end() - 1, [](unsigned char b) { return b == 0; });
}

bool PeerAddress::is_ipv4() const noexcept {
    return std::equal(mapped.begin(), mapped.end(), bytes_.begin());
}

PeerAddress PeerAddress::share() const noexcept {
    PeerAddress share = *this;
    if (!is_ipv4() && !is_this_machine()) std::fill(share.bytes_.begin() + network_bytes, share.bytes_.end(), 0);
    return share;
}

std::string PeerAddress::text() const {
    if (*this == PeerAddress{}) return "this machine";
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (is_ipv4())
        ::inet_ntop(AF_INET, bytes_.data() + mapped.size(), text.data(), text.size());
    else
        ::inet_ntop(AF_INET6, bytes_.data(), text.data(), text.size());
    return text.data();
}

}  // namespace meniscus::server
