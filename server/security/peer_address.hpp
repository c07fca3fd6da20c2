// The address of the other end of a connection, as limits for each address count it.
#pragma once

#include <sys/socket.h>

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace meniscus::server {

/// An IPv4 address, also where it came as IPv6 (::ffff:192.0.2.7); an IPv6 address; or nothing but this machine: a Unix
/// socket or this process. Without port.
class PeerAddress {
public:
    /// The address of this machine.
    PeerAddress() = default;
    /// The peer at this address; this machine for another family than IPv4 and IPv6.
    explicit PeerAddress(const sockaddr& address);

    /// The peer by gRPC's words, such as "ipv4:192.0.2.7:50000", "ipv6:%5B2001:db8::1%5D:50000", "unix:" and "inproc".
    static PeerAddress of_grpc(std::string_view peer);
    /// The address "192.0.2.7" or "2001:db8::1"; none for anything else. Names are not looked up.
    static std::optional<PeerAddress> parse(const std::string& text);

    /// Whether it is a Unix socket, 127.0.0.0/8 or ::1.
    bool is_this_machine() const noexcept;
    bool is_ipv4() const noexcept;
    /// The addresses that one limit is for: the address itself, or the network of 64 bits of an IPv6 address, which one
    /// machine has to itself.
    PeerAddress share() const noexcept;
    /// "192.0.2.7", "2001:db8::1", or "this machine".
    std::string text() const;
    /// The address as IPv6, IPv4 within ::ffff:0:0/96; zero for this machine.
    const std::array<unsigned char, 16>& bytes() const noexcept { return bytes_; }

    std::strong_ordering operator<=>(const PeerAddress&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here

private:
    std::array<unsigned char, 16> bytes_{};
};

}  // namespace meniscus::server
