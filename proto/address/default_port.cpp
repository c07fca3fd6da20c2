#include "address/default_port.hpp"

#include <algorithm>

namespace meniscus::address {

std::string with_port(const std::string& address) {
    const bool is_host =
        address.starts_with('[') ? address.ends_with(']') : address.find_first_of(":/") == address.npos;
    return is_host && !address.empty() ? address + ":" + std::string(default_port) : address;
}

bool is_bare_ipv6(const std::string& address) {
    return std::count(address.begin(), address.end(), ':') > 1 &&
           address.find_first_not_of("0123456789abcdefABCDEF:.") == address.npos;
}

}  // namespace meniscus::address
