// Where a server may listen.
#pragma once

#include <string>
#include <string_view>

namespace meniscus::server {

/// For a port without TLS. Throws InvalidInput, which names the flag, if other machines can reach the address.
void require_loopback(std::string_view flag, const std::string& address);

/// Throws InvalidInput if the address is a Unix socket whose path cannot be one, or that another server listens on:
/// gRPC would take it over.
void require_unused_unix_socket(const std::string& address);

}  // namespace meniscus::server
