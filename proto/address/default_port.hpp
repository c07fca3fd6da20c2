// The port of a server that is named by its host alone.
#pragma once

#include <string>
#include <string_view>

namespace meniscus::address {

/// The port of meniscusd where none is given.
inline constexpr std::string_view default_port = "50051";

/// "HOST" and "[IPV6]" with the default port; as it is what names a port, a Unix socket, or a scheme of gRPC's.
std::string with_port(const std::string& address);

/// Whether what follows the host is no port: 1 to 65535, http or https. gRPC takes what it can of it, which is another
/// port. False for what has a scheme of gRPC's, and for a host alone.
bool has_bad_port(const std::string& address);

/// Whether this looks like an IPv6 address without the brackets that separate it from a port.
bool is_bare_ipv6(const std::string& address);

}  // namespace meniscus::address
