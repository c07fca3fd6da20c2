// Connections that only take room.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

namespace meniscus::server::test {

class AttackSockets {
public:
    /// address: "127.0.0.1:PORT", or another of IPv4.
    AttackSockets(const std::string& address, std::size_t count) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
        ::inet_pton(AF_INET, address.substr(0, address.rfind(':')).c_str(), &to.sin_addr);
        for (std::size_t i = 0; i < count; ++i) {
            const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
            if (socket < 0) break;
            sockets_.push_back(socket);
            // The socket does not wait, so the result says nothing yet.
            static_cast<void>(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to));
        }
    }
    ~AttackSockets() {
        for (const int socket : sockets_) ::close(socket);
    }
    AttackSockets(const AttackSockets&) = delete;
    AttackSockets& operator=(const AttackSockets&) = delete;

    std::size_t size() const noexcept { return sockets_.size(); }

private:
    std::vector<int> sockets_;
};

}  // namespace meniscus::server::test
