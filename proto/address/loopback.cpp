#include "address/loopback.hpp"

#include <arpa/inet.h>

#include <string>

namespace meniscus::address {

bool is_loopback(std::string_view address) {
    if (address.starts_with("unix:")) return true;
    const std::string host(address.substr(0, address.rfind(':')));
    if (host == "localhost" || host == "[::1]") return true;
    in_addr ip{};
    return ::inet_pton(AF_INET, host.c_str(), &ip) == 1 && (ntohl(ip.s_addr) >> 24U) == 127;
}

}  // namespace meniscus::address
