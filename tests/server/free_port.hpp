// A port for a program that cannot choose one itself.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <random>
#include <stdexcept>

namespace meniscus::server::test {

/// One on loopback that was free a moment ago. The kernel gives none below 32768 by itself, so that no connection of a
/// test beside takes it meanwhile.
inline int free_port() {
    constexpr int lowest = 16384;
    constexpr int above = 32768;
    std::random_device random;
    std::uniform_int_distribution<int> ports(lowest, above - 1);
    for (int tries = 0; tries < 100; ++tries) {
        const int port = ports(random);
        const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        const bool found = ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
        ::close(listener);
        if (found) return port;
    }
    throw std::runtime_error("no free port");
}

}  // namespace meniscus::server::test
