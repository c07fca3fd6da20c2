#include "address/default_port.hpp"

#include <arpa/inet.h>

namespace meniscus::address {

std::string with_port(const std::string& address) {
    const bool is_host =
        address.starts_with('[') ? address.ends_with(']') : address.find_first_of(":/") == address.npos;
    return is_host && !address.empty() ? address + ":" + std::string(default_port) : address;
}

bool is_bare_ipv6(const std::string& address) {
    in6_addr ip{};
    return ::inet_pton(AF_INET6, address.c_str(), &ip) == 1;
}

}  // namespace meniscus::address
