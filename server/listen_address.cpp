#include "listen_address.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "address/loopback.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

void require_loopback(std::string_view flag, const std::string& address) {
    if (address::is_loopback(address)) return;
    throw InvalidInput(
        fmt::format("{} {} can be reached from other machines, without TLS: give a loopback address, or --insecure "
                    "if this is meant (--tls-cert and --tls-key give --listen TLS)",
                    flag, address));
}

void require_unused_unix_socket(const std::string& address) {
    constexpr std::string_view scheme = "unix:";
    if (!address.starts_with(scheme)) return;
    std::string path = address.substr(scheme.size());
    if (path.starts_with("//")) path.erase(0, 2);
    sockaddr_un socket_address{};
    socket_address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof socket_address.sun_path)
        throw InvalidInput(fmt::format("cannot listen on {}: the path must have 1 to {} bytes", address,
                                       sizeof socket_address.sun_path - 1));
    path.copy(socket_address.sun_path, path.size());
    const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (probe < 0) return;
    const bool in_use =
        ::connect(probe, reinterpret_cast<const sockaddr*>(&socket_address), sizeof socket_address) == 0;
    ::close(probe);
    if (in_use) throw InvalidInput(fmt::format("cannot listen on {}: the address is in use", address));
}

}  // namespace meniscus::server
