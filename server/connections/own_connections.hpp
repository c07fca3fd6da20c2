// Connections that the server makes to itself, to see whether its port answers.
#pragma once

#include <sys/socket.h>

#include <mutex>
#include <set>
#include <string>

namespace meniscus::server {

/// By the address that they come from, as the port sees it. They have places of their own. Thread-safe.
class OwnConnections {
public:
    void expect(const sockaddr& address, socklen_t size);
    void forget(const sockaddr& address, socklen_t size);
    bool includes(const sockaddr& address, socklen_t size) const;

private:
    mutable std::mutex mutex_;
    std::set<std::string> expected_;
};

}  // namespace meniscus::server
