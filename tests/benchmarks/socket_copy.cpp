#include "socket_copy.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace meniscus::benchmarks {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20;

using Ends = std::array<int, 2>;

Ends connected_tcp() {
    const int listening = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof address;
    const int client = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::bind(listening, generic, size) != 0 || ::listen(listening, 1) != 0 ||
        ::getsockname(listening, generic, &size) != 0 || ::connect(client, generic, size) != 0)
        throw std::runtime_error("no TCP connection on the loopback address");
    const int server = ::accept(listening, nullptr, nullptr);
    ::close(listening);
    return {client, server};
}

Ends connected(Transport transport) {
    if (transport == Transport::tcp) return connected_tcp();
    Ends ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw std::runtime_error("no Unix socket");
    return ends;
}

}  // namespace

double socket_bytes_per_second(Transport transport, std::size_t bytes) {
    const auto [client, server] = connected(transport);
    const std::vector<std::byte> source(piece);
    std::vector<std::byte> sink(piece);
    const auto start = std::chrono::steady_clock::now();
    std::thread sending([&, to = client] {
        for (std::size_t left = bytes; left > 0;) {
            const ssize_t sent = ::send(to, source.data(), std::min(left, piece), MSG_NOSIGNAL);
            if (sent <= 0) return;
            left -= static_cast<std::size_t>(sent);
        }
    });
    for (std::size_t left = bytes; left > 0;) {
        const ssize_t received = ::recv(server, sink.data(), std::min(left, piece), 0);
        if (received <= 0) break;
        left -= static_cast<std::size_t>(received);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    sending.join();
    ::close(client);
    ::close(server);
    return static_cast<double>(bytes) / seconds.count();
}

}  // namespace meniscus::benchmarks
