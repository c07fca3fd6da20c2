// Where a server may listen.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "process/unavailable.hpp"

namespace meniscus::server {

/// An address that is right, but another program has it, or this machine has not.
struct AddressUnavailable : Unavailable {
    using Unavailable::Unavailable;
};

struct HostPort {
    std::string host;  ///< IPv6 without brackets
    std::uint16_t port = 0;
};

/// The parts of "HOST:PORT" or "[IPv6]:PORT". Throws InvalidInput, which names the flag, for anything else.
HostPort parse_host_port(std::string_view flag, const std::string& address);

/// The path of "unix:PATH" or "unix:///PATH"; empty for another address. Throws InvalidInput for one that is empty or
/// too long.
std::string unix_path(const std::string& address);

/// Throws InvalidInput unless it is HOST:PORT, [IPv6]:PORT or unix:PATH.
void require_listen_address(const std::string& address);

/// For a port without TLS. Throws InvalidInput, which names the flag, if other machines can reach the address.
void require_loopback(std::string_view flag, const std::string& address);

}  // namespace meniscus::server
