// Where a server may listen.
#pragma once

#include <string>
#include <string_view>

namespace meniscus::server {

/// Throws InvalidInput if the address, of this flag, can be reached from other machines without TLS, and --insecure does
/// not say that this is meant.
void require_protected(std::string_view flag, const std::string& address, bool tls, bool insecure);

/// Throws InvalidInput if the address is a Unix socket whose path cannot be one, or that another server listens on: gRPC
/// would take it over.
void require_unused_unix_socket(const std::string& address);

}  // namespace meniscus::server
