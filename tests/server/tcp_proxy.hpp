// A connection that can be cut: it stands between a client and a server on this machine.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace meniscus::server::test {

class TcpProxy {
public:
    /// upstream: port on the loopback address. distance: time that a connection takes, as to a machine far away.
    explicit TcpProxy(std::uint16_t upstream, std::chrono::milliseconds distance = {})
        : upstream_(upstream), distance_(distance) {
        listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address = loopback(0);
        socklen_t size = sizeof address;
        if (::bind(listening_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
            ::listen(listening_, 16) != 0 ||
            ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
            throw std::runtime_error("the proxy cannot listen");
        port_ = ntohs(address.sin_port);
        accepting_ = std::thread([this] { accept_connections(); });
    }
    ~TcpProxy() {
        ::shutdown(listening_, SHUT_RDWR);
        accepting_.join();
        cut();
        for (std::thread& thread : forwarding_) thread.join();
        for (const int socket : sockets_) ::close(socket);
        ::close(listening_);
    }
    TcpProxy(const TcpProxy&) = delete;
    TcpProxy& operator=(const TcpProxy&) = delete;

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

    /// Ends all connections, and for this time each new one at once.
    void refuse_for(std::chrono::milliseconds time) {
        refuses_until_ = std::chrono::steady_clock::now() + time;
        cut();
    }

    /// Ends all connections; new ones may be made.
    void cut() {
        const std::lock_guard lock(mutex_);
        for (const int socket : sockets_) ::shutdown(socket, SHUT_RDWR);
    }

    /// From now on nothing arrives, on either side, and no connection ends: as from a server that was stopped.
    void swallow() { swallows_ = true; }

    /// From now on nothing is read, on either side, and no connection ends: a client that goes on writing waits.
    void stall() { stalls_ = true; }

private:
    static sockaddr_in loopback(std::uint16_t port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return address;
    }

    void accept_connections() {
        for (;;) {
            const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
            if (client < 0) return;
            if (std::chrono::steady_clock::now() < refuses_until_.load()) {
                ::close(client);
                continue;
            }
            std::this_thread::sleep_for(distance_);
            const int server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
            const sockaddr_in address = loopback(upstream_);
            const std::lock_guard lock(mutex_);
            sockets_.insert(sockets_.end(), {client, server});
            if (::connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
                ::shutdown(client, SHUT_RDWR);
                continue;
            }
            forwarding_.emplace_back([this, client, server] { forward(client, server); });
        }
    }

    void forward(int client, int server) const {
        std::array<pollfd, 2> ends{pollfd{client, POLLIN, 0}, pollfd{server, POLLIN, 0}};
        while (::poll(ends.data(), ends.size(), -1) > 0)
            for (std::size_t from = 0; from < 2; ++from) {
                if (ends[from].revents == 0) continue;
                if (stalls_) return;
                if (pass_on(ends[from].fd, ends[1 - from].fd)) continue;
                ::shutdown(client, SHUT_RDWR);
                ::shutdown(server, SHUT_RDWR);
                return;
            }
    }

    bool pass_on(int from, int to) const {
        std::array<char, 65536> buffer{};
        const ssize_t size = ::recv(from, buffer.data(), buffer.size(), 0);
        for (ssize_t sent = 0; sent < size && !swallows_;) {
            const ssize_t more = ::send(to, buffer.data() + sent, static_cast<std::size_t>(size - sent), MSG_NOSIGNAL);
            if (more <= 0) return false;
            sent += more;
        }
        return size > 0;
    }

    const std::uint16_t upstream_;
    const std::chrono::milliseconds distance_;
    std::atomic<std::chrono::steady_clock::time_point> refuses_until_{std::chrono::steady_clock::time_point::min()};
    int listening_ = -1;
    std::uint16_t port_ = 0;
    std::mutex mutex_;  ///< for the next two
    std::vector<int> sockets_;
    std::vector<std::thread> forwarding_;
    std::atomic<bool> swallows_{false};
    std::atomic<bool> stalls_{false};
    std::thread accepting_;
};

}  // namespace meniscus::server::test
