#include "connections/port_check.hpp"

#include <netinet/in.h>
#include <openssl/ssl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

namespace {

constexpr int failures_allowed = 2;

struct SocketAddress {
    sockaddr_storage storage{};
    socklen_t size = sizeof(sockaddr_storage);

    sockaddr& get() { return reinterpret_cast<sockaddr&>(storage); }
    const sockaddr& get() const { return reinterpret_cast<const sockaddr&>(storage); }
};

SocketAddress loopback(std::uint16_t port) {
    SocketAddress address;
    auto& ipv4 = reinterpret_cast<sockaddr_in&>(address.storage);
    ipv4.sin_family = AF_INET;
    ipv4.sin_port = port;
    ipv4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.size = sizeof ipv4;
    return address;
}

/// Where a client of this machine connects to.
SocketAddress address_of(int listening) {
    SocketAddress address;
    ::getsockname(listening, &address.get(), &address.size);
    if (const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address.storage);
        ipv4.sin_family == AF_INET && ipv4.sin_addr.s_addr == htonl(INADDR_ANY))
        return loopback(ipv4.sin_port);
    if (const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(address.storage);
        ipv6.sin6_family == AF_INET6 && IN6_IS_ADDR_UNSPECIFIED(&ipv6.sin6_addr))
        return loopback(ipv6.sin6_port);
    return address;
}

/// A place to connect from that is known before the connection is. Of Unix sockets a name that the kernel chooses.
SocketAddress bind_near(int socket, const sockaddr& server, socklen_t size) {
    SocketAddress own;
    own.storage.ss_family = server.sa_family;
    own.size = server.sa_family == AF_UNIX ? sizeof(sa_family_t) : size;
    if (server.sa_family == AF_INET)
        reinterpret_cast<sockaddr_in&>(own.storage).sin_addr = reinterpret_cast<const sockaddr_in&>(server).sin_addr;
    if (server.sa_family == AF_INET6)
        reinterpret_cast<sockaddr_in6&>(own.storage).sin6_addr =
            reinterpret_cast<const sockaddr_in6&>(server).sin6_addr;
    static_cast<void>(::bind(socket, &own.get(), own.size));
    own.size = sizeof own.storage;
    ::getsockname(socket, &own.get(), &own.size);
    return own;
}

bool send_all(int socket, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

template <std::size_t size>
bool receive_all(int socket, std::array<unsigned char, size>& bytes) {
    return ::recv(socket, bytes.data(), size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

bool skip(int socket, std::size_t bytes) {
    std::array<char, 4096> skipped{};
    while (bytes != 0) {
        const ssize_t received = ::recv(socket, skipped.data(), std::min(bytes, skipped.size()), 0);
        if (received <= 0) return false;
        bytes -= static_cast<std::size_t>(received);
    }
    return true;
}

/// Frames of HTTP/2: 3 bytes of length, type, flags, 4 bytes of stream, then the content.
bool answers_ping(int socket) {
    using namespace std::string_view_literals;
    constexpr std::string_view hello =
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
        "\0\0\0\x04\0\0\0\0\0"               // settings: none
        "\0\0\x08\x06\0\0\0\0\0meniscus"sv;  // ping
    constexpr unsigned char ping = 6;
    constexpr unsigned char acknowledged = 1;
    if (!send_all(socket, hello)) return false;
    for (std::array<unsigned char, 9> header{}; receive_all(socket, header);) {
        if (header[3] == ping && header[4] == acknowledged) return true;
        const std::size_t size = header[0] << 16U | header[1] << 8U | header[2];
        if (!skip(socket, size)) return false;
    }
    return false;
}

std::string client_hello() {
    const std::unique_ptr<SSL_CTX, decltype(&::SSL_CTX_free)> context(::SSL_CTX_new(::TLS_client_method()),
                                                                      ::SSL_CTX_free);
    const std::unique_ptr<SSL, decltype(&::SSL_free)> ssl(::SSL_new(context.get()), ::SSL_free);
    if (!ssl) return {};
    BIO* const outgoing = ::BIO_new(::BIO_s_mem());
    ::SSL_set_bio(ssl.get(), ::BIO_new(::BIO_s_mem()), outgoing);
    constexpr std::array<unsigned char, 3> http2{2, 'h', '2'};
    ::SSL_set_alpn_protos(ssl.get(), http2.data(), http2.size());
    ::SSL_connect(ssl.get());  // as far as it goes without an answer
    char* bytes = nullptr;
    const long size = BIO_get_mem_data(outgoing, &bytes);
    return {bytes, static_cast<std::size_t>(std::max(size, 0L))};
}

/// Reads no further: a client that leaves now is none that has failed to show a certificate.
bool answers_hello(int socket) {
    constexpr unsigned char handshake = 22;
    constexpr unsigned char server_hello = 2;
    std::array<unsigned char, 6>
        answer{};  // of a record: type, 2 bytes of version, 2 of length; then of a message: type
    return send_all(socket, client_hello()) && receive_all(socket, answer) && answer.front() == handshake &&
           answer.back() == server_hello;
}

}  // namespace

PortCheck::PortCheck(std::vector<int> sockets, Protocol protocol, OwnConnections& own, Times times)
    : sockets_(std::move(sockets)), protocol_(protocol), own_(own), times_(times), thread_([this] { run(); }) {}

PortCheck::~PortCheck() {
    stop();
}

void PortCheck::stop() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        if (connection_ >= 0) ::shutdown(connection_, SHUT_RDWR);
    }
    stopping_.notify_one();
    thread_.join();
}

void PortCheck::run() {
    std::vector<SocketAddress> servers;
    servers.reserve(sockets_.size());
    for (const int socket : sockets_) servers.push_back(address_of(socket));
    for (;;) {
        Result result = Result::answered;
        for (const SocketAddress& server : servers)
            if (result == Result::answered) result = check(server.get(), server.size);
        std::unique_lock lock(mutex_);
        if (stopped_) return;
        judge(result);
        if (stopping_.wait_for(lock, times_.between, [this] { return stopped_; })) return;
    }
}

void PortCheck::judge(Result result) {
    failures_ = result == Result::silent ? failures_ + 1 : 0;
    const bool answers = failures_ <= failures_allowed;
    if (answers_.exchange(answers) == answers) return;
    if (answers)
        spdlog::info("the gRPC port answers again");
    else
        spdlog::error("the gRPC port does not answer, though there is room: /healthz says so");
}

PortCheck::Result PortCheck::check(const sockaddr& server, socklen_t size) {
    const int connection = ::socket(server.sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connection < 0) return Result::no_room;
    const auto patience = std::chrono::duration_cast<std::chrono::microseconds>(times_.patience).count();
    const timeval limit{.tv_sec = patience / 1'000'000, .tv_usec = patience % 1'000'000};
    for (const int option : {SO_SNDTIMEO, SO_RCVTIMEO})  // the first one is also connect()'s
        ::setsockopt(connection, SOL_SOCKET, option, &limit, sizeof limit);
    const SocketAddress own = bind_near(connection, server, size);
    own_.expect(own.get(), own.size);
    const bool answered = use(connection) && ::connect(connection, &server, size) == 0 &&
                          (protocol_ == Protocol::tls ? answers_hello(connection) : answers_ping(connection));
    close(connection);
    own_.forget(own.get(), own.size);
    return answered ? Result::answered : Result::silent;
}

bool PortCheck::use(int connection) {
    const std::lock_guard lock(mutex_);
    connection_ = connection;
    return !stopped_;
}

void PortCheck::close(int connection) {
    const std::lock_guard lock(mutex_);
    connection_ = -1;
    ::close(connection);
}

}  // namespace meniscus::server
