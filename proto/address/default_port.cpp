#include "address/default_port.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace meniscus::address {

std::string with_port(const std::string& address) {
    const bool is_host =
        address.starts_with('[') ? address.ends_with(']') : address.find_first_of(":/") == address.npos;
    return is_host && !address.empty() ? address + ":" + std::string(default_port) : address;
}

bool has_bad_port(const std::string& address) {
    constexpr std::array schemes{"dns", "google-c2p", "ipv4", "ipv6", "unix", "unix-abstract", "vsock", "xds"};
    const bool bracketed = address.starts_with('[');
    const std::size_t colon = bracketed ? address.rfind("]:") + 1 : address.find(':');
    if (colon == address.npos || (bracketed && colon == 0)) return false;
    if (std::find(schemes.begin(), schemes.end(), address.substr(0, colon)) != schemes.end()) return false;
    if (address.find('/') != address.npos) return false;
    const std::string_view port = std::string_view(address).substr(colon + 1);
    if (port == "http" || port == "https") return false;  // gRPC knows them
    std::uint16_t number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    return error != std::errc() || end != port.data() + port.size() || number == 0;
}

bool is_bare_ipv6(const std::string& address) {
    return std::count(address.begin(), address.end(), ':') > 1 &&
           address.find_first_not_of("0123456789abcdefABCDEF:.") == address.npos;
}

}  // namespace meniscus::address
