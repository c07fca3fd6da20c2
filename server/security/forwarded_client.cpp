#include "security/forwarded_client.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace meniscus::server {

namespace {

/// The address in an entry such as "192.0.2.7", "192.0.2.7:50000", "2001:db8::1" or "[2001:db8::1]:50000".
std::optional<PeerAddress> address_in(std::string_view entry) {
    constexpr std::string_view spaces = " \t";
    entry.remove_prefix(std::min(entry.size(), entry.find_first_not_of(spaces)));
    entry = entry.substr(0, entry.find_last_not_of(spaces) + 1);
    if (entry.starts_with('['))
        entry = entry.substr(1, entry.find(']') - 1);
    else if (std::ranges::count(entry, ':') == 1)
        entry = entry.substr(0, entry.find(':'));
    return PeerAddress::parse(std::string(entry));
}

}  // namespace

std::optional<PeerAddress> forwarded_client(const TrustedPeers& trusted, const PeerAddress& peer,
                                            std::span<const std::string_view> headers) {
    std::optional<PeerAddress> client;
    if (!trusted.is_proxy(peer)) return client;
    for (std::size_t left = headers.size(); left > 0; --left) {
        std::string_view rest = headers[left - 1];
        while (!rest.empty()) {
            const std::size_t comma = rest.rfind(',');
            const auto noted = address_in(rest.substr(comma + 1));
            if (!noted) return client;
            client = noted;
            if (!trusted.is_proxy(*client)) return client;
            rest = rest.substr(0, comma == std::string_view::npos ? 0 : comma);
        }
    }
    return client;
}

}  // namespace meniscus::server
