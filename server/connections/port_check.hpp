// Asks the server's own gRPC port, again and again, whether it answers. For /healthz: orchestrators probe it by HTTP,
// and restart a server whose gRPC port hangs while its HTTP port still answers.
#pragma once

#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "connections/own_connections.hpp"

namespace meniscus::server {

/// Connects as a client does. Without TLS it waits for the answer to a ping of HTTP/2; with TLS, mutual or not, for the
/// server's part of the handshake, which needs no certificate of a client. Either shows that connections are accepted
/// and that gRPC's threads work.
class PortCheck {
public:
    struct Times {
        std::chrono::milliseconds between = std::chrono::seconds(1);
        std::chrono::milliseconds patience = std::chrono::seconds(2);  ///< for each of a few steps
    };
    enum class Protocol { http2, tls };

    /// sockets: that the port listens on. own: learns of each connection before it is made.
    PortCheck(std::vector<int> sockets, Protocol protocol, OwnConnections& own, Times times);
    PortCheck(std::vector<int> sockets, Protocol protocol, OwnConnections& own)
        : PortCheck(std::move(sockets), protocol, own, Times{}) {}
    ~PortCheck();
    PortCheck(const PortCheck&) = delete;
    PortCheck& operator=(const PortCheck&) = delete;

    /// False once three checks in a row have failed. A check for which there is no descriptor does not count.
    bool answers() const noexcept { return answers_; }
    /// Stops the checks: from then on answers() does not change.
    void stop();

private:
    enum class Result { answered, silent, no_room };

    void run();
    Result check(const sockaddr& server, socklen_t size);
    void judge(Result result);
    /// For stop(), which cuts the connection in use off. False if that has been called.
    bool use(int connection);
    void close(int connection);

    const std::vector<int> sockets_;
    const Protocol protocol_;
    OwnConnections& own_;
    const Times times_;
    std::atomic<bool> answers_{true};
    int failures_ = 0;

    std::mutex mutex_;  ///< for what follows
    std::condition_variable stopping_;
    bool stopped_ = false;
    int connection_ = -1;

    std::thread thread_;  ///< last: it uses the others
};

}  // namespace meniscus::server
