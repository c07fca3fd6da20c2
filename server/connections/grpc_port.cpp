#include "connections/grpc_port.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

namespace meniscus::server {

namespace {

/// Milliseconds after an accept that failed.
constexpr int accept_pause = 100;

int make_event() {
    const int event = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (event < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    return event;
}

/// Whether the next accept may succeed at once: the error is that of one connection, not of the process or the socket.
bool concerns_one_connection(int error) {
    constexpr std::array others{EMFILE, ENFILE, ENOBUFS, ENOMEM, EBADF, EINVAL, ENOTSOCK, EOPNOTSUPP};
    return std::ranges::find(others, error) == others.end();
}

}  // namespace

GrpcPort::GrpcPort(const std::string& address, const ConnectionLimits& limits, TrustedPeers trusted)
    : sockets_(address), wake_(make_event()), table_(limits, std::move(trusted)) {}

GrpcPort::~GrpcPort() {
    stop();
    ::close(wake_);
}

void GrpcPort::start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc) {
    grpc_ = std::move(grpc);
    thread_ = std::thread([this] { run(); });
}

void GrpcPort::stop() {
    if (!thread_.joinable()) return;
    ::eventfd_write(wake_, 1);
    thread_.join();
}

GrpcPort::Counts GrpcPort::counts() {
    const std::lock_guard lock(mutex_);
    counts_.connections = table_.sweep();
    return counts_;
}

void GrpcPort::run() {
    std::vector<pollfd> ready{{.fd = wake_, .events = POLLIN, .revents = 0}};
    for (const int socket : sockets_.descriptors()) ready.push_back({.fd = socket, .events = POLLIN, .revents = 0});
    for (bool pause = false;;) {
        // In a pause only the wake-up counts: sockets that cannot be accepted from stay readable.
        ::poll(ready.data(), pause ? 1 : ready.size(), pause ? accept_pause : -1);
        if (ready.front().revents != 0) return;
        pause = false;
        for (const int socket : sockets_.descriptors()) pause = !accept_all(socket) || pause;
    }
}

bool GrpcPort::accept_all(int socket) {
    // Not without end: the wake-up and the other sockets have their turn, too.
    constexpr int most = 1024;
    for (int i = 0; i < most; ++i) {
        if (accept_one(socket)) continue;
        if (errno == EAGAIN) return true;
        if (concerns_one_connection(errno)) continue;
        const int error = errno;
        if (const auto left = failures_.pass())
            spdlog::warn("a connection to {} was not accepted: {}{}", address(), std::strerror(error), left_out(*left));
        return false;
    }
    return true;
}

bool GrpcPort::accept_one(int socket) {
    sockaddr_storage storage{};
    socklen_t size = sizeof storage;
    auto& peer = reinterpret_cast<sockaddr&>(storage);
    const int connection = ::accept4(socket, &peer, &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (connection < 0) return false;
    if (!own_.includes(peer, size) && !admit(connection, PeerAddress(peer))) {
        ::close(connection);
        return true;
    }
    received_bytes_.enter(connection, peer);
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
    parameters.listener_fd = socket;
    parameters.fd = connection;
    grpc_->HandleNewConnection(&parameters);
    return true;
}

bool GrpcPort::admit(int connection, const PeerAddress& peer) {
    ConnectionTable::Verdict verdict{};
    {
        const std::lock_guard lock(mutex_);
        verdict = table_.admit(connection, peer);
        if (verdict == ConnectionTable::Verdict::too_many) ++counts_.refused_of_all;
        if (verdict == ConnectionTable::Verdict::too_many_of_peer) ++counts_.refused_of_peers;
    }
    if (verdict == ConnectionTable::Verdict::admitted) return true;
    const auto left = refusals_.pass();
    if (!left) return false;
    const ConnectionLimits& limits = table_.limits();
    if (verdict == ConnectionTable::Verdict::too_many)
        spdlog::warn(
            "a connection from {} to {} was refused: there are {}, as many as may be (--max-connections, and the "
            "limit of descriptors){}",
            peer.text(), address(), limits.all, left_out(*left));
    else
        spdlog::warn(
            "a connection from {} to {} was refused: it has {}, as many as one address may have "
            "(--max-connections-per-peer; --trusted-proxies have no such limit){}",
            peer.text(), address(), limits.for_each_peer, left_out(*left));
    return false;
}

}  // namespace meniscus::server
