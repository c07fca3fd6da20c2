#include "connections/listening_sockets.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "connections/listen_address.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

/// Milliseconds that what was sent may stay unconfirmed: as long as gRPC waits for the answer to its own question.
constexpr int unconfirmed_time = 20'000;

/// A socket that is closed unless it is taken.
class Socket {
public:
    explicit Socket(int family) : descriptor_(::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
    ~Socket() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    void set(int level, int name, int value) const { ::setsockopt(descriptor_, level, name, &value, sizeof value); }
    /// False with errno.
    bool listen_on(const sockaddr& address, socklen_t size) const {
        return ::bind(descriptor_, &address, size) == 0 && ::listen(descriptor_, SOMAXCONN) == 0;
    }
    bool connects_to(const sockaddr& address, socklen_t size) const {
        return ::connect(descriptor_, &address, size) == 0;
    }
    int take() { return std::exchange(descriptor_, -1); }

private:
    int descriptor_;
};

struct Address {
    sockaddr_storage storage{};
    socklen_t size = 0;

    sockaddr& get() { return reinterpret_cast<sockaddr&>(storage); }
    std::uint16_t& port() {
        return storage.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(storage).sin6_port
                                             : reinterpret_cast<sockaddr_in&>(storage).sin_port;
    }
};

bool is_every_address(const Address& address) {
    if (address.storage.ss_family == AF_INET)
        return reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr == htonl(INADDR_ANY);
    return IN6_IS_ADDR_UNSPECIFIED(&reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr);
}

Address every_address(std::uint16_t port) {
    Address address;
    auto& ipv6 = reinterpret_cast<sockaddr_in6&>(address.storage);
    ipv6.sin6_family = AF_INET6;
    ipv6.sin6_port = port;
    address.size = sizeof ipv6;
    return address;
}

std::vector<Address> resolve(const std::string& listen) {
    const HostPort host_port = parse_host_port("--listen", listen);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo* found = nullptr;
    const int error = ::getaddrinfo(host_port.host.c_str(), std::to_string(host_port.port).c_str(), &hints, &found);
    if (error != 0) throw InvalidInput(fmt::format("cannot listen on {}: {}", listen, ::gai_strerror(error)));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(found, ::freeaddrinfo);
    std::vector<Address> addresses;
    for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
        Address& address = addresses.emplace_back();
        address.size = each->ai_addrlen;
        std::memcpy(&address.storage, each->ai_addr, each->ai_addrlen);
    }
    return addresses;
}

/// None, with errno, if it cannot be listened on.
std::optional<int> listen_on(Address& address) {
    Socket socket(address.storage.ss_family);
    if (!socket.is_open()) return std::nullopt;
    socket.set(SOL_SOCKET, SO_REUSEADDR, 1);
    // Connections have these from the socket that they came by.
    socket.set(IPPROTO_TCP, TCP_NODELAY, 1);
    socket.set(IPPROTO_TCP, TCP_USER_TIMEOUT, unconfirmed_time);
    if (address.storage.ss_family == AF_INET6) socket.set(IPPROTO_IPV6, IPV6_V6ONLY, is_every_address(address) ? 0 : 1);
    if (!socket.listen_on(address.get(), address.size)) return std::nullopt;
    const int descriptor = socket.take();
    ::getsockname(descriptor, &address.get(), &address.size);
    return descriptor;
}

[[noreturn]] void refuse(const std::string& address, int error) {
    throw AddressUnavailable(error == EADDRINUSE
                                 ? fmt::format("cannot listen on {}: the address is in use, perhaps by another "
                                               "meniscusd: --listen names another one",
                                               address)
                                 : fmt::format("cannot listen on {}: {}", address, std::strerror(error)));
}

}  // namespace

ListeningSockets::ListeningSockets(const std::string& address) {
    try {
        if (const std::string path = unix_path(address); !path.empty()) {
            listen_on_path(path);
            address_ = address;
        } else {
            listen_on_host(address);
        }
    } catch (...) {
        close();
        throw;
    }
}

ListeningSockets::~ListeningSockets() {
    close();
}

void ListeningSockets::close() {
    for (const int socket : sockets_) ::close(socket);
    if (!path_.empty()) ::unlink(path_.c_str());
}

void ListeningSockets::listen_on_path(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, path.size());
    const auto& generic = reinterpret_cast<const sockaddr&>(address);
    // A socket that a killed server has left behind is taken over; one that a server listens on is not.
    const Socket probe(AF_UNIX);
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) {
        if (probe.connects_to(generic, sizeof address)) refuse("unix:" + path, EADDRINUSE);
        ::unlink(path.c_str());
    }
    Socket socket(AF_UNIX);
    if (!socket.is_open() || !socket.listen_on(generic, sizeof address)) refuse("unix:" + path, errno);
    path_ = path;
    sockets_.push_back(socket.take());
}

void ListeningSockets::listen_on_host(const std::string& address) {
    std::vector<Address> addresses = resolve(address);
    int error = EADDRNOTAVAIL;
    // Every address of this machine, IPv4 and IPv6, is one socket where there is IPv6.
    if (is_every_address(addresses.front())) {
        Address both = every_address(addresses.front().port());
        if (const auto socket = listen_on(both)) {
            sockets_.push_back(*socket);
            addresses = {both};
        } else if (errno != EAFNOSUPPORT && errno != EADDRNOTAVAIL) {
            refuse(address, errno);
        }
    }
    std::uint16_t port = addresses.front().port();
    if (sockets_.empty())
        for (Address& each : addresses) {
            each.port() = port;
            if (const auto socket = listen_on(each)) {
                sockets_.push_back(*socket);
                port = each.port();
                continue;
            }
            error = errno;
            // A name may have addresses that this machine has not, such as that of IPv6; what is in use is.
            if (error != EADDRNOTAVAIL && error != EAFNOSUPPORT) refuse(address, error);
        }
    if (sockets_.empty()) refuse(address, error);
    address_ = fmt::format("{}:{}", address.substr(0, address.rfind(':')), ntohs(port));
}

}  // namespace meniscus::server
