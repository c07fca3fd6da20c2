// Servers that are reached by a port, so that they can be cut off, and others can take their place.
#pragma once

#include <cstdint>
#include <string>

#include "running_server.hpp"

namespace meniscus::server::test {

inline ServerOptions on_tcp(std::uint16_t port = 0) {
    ServerOptions options = test_options();
    options.listen = "127.0.0.1:" + std::to_string(port);
    return options;
}

inline std::uint16_t port_of(const std::string& address) {
    return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
}

}  // namespace meniscus::server::test
