// The sockets that the gRPC port listens on.
#pragma once

#include <string>
#include <vector>

namespace meniscus::server {

/// One socket for each address of a host's name; a Unix socket's file goes with it.
class ListeningSockets {
public:
    /// address: "HOST:PORT", "[IPv6]:PORT" or "unix:PATH". Port 0 chooses one; 0.0.0.0 and [::] are every address of
    /// this machine. Listens when it returns. Throws InvalidInput if it is no address, AddressUnavailable if it is in
    /// use or not one of this machine.
    explicit ListeningSockets(const std::string& address);
    ~ListeningSockets();
    ListeningSockets(const ListeningSockets&) = delete;
    ListeningSockets& operator=(const ListeningSockets&) = delete;

    const std::vector<int>& descriptors() const noexcept { return sockets_; }
    /// The address in the form that clients use, with the port that was chosen.
    const std::string& address() const noexcept { return address_; }

private:
    void listen_on_path(const std::string& path);
    void listen_on_host(const std::string& address);
    void close();

    std::vector<int> sockets_;
    std::string address_;
    std::string path_;  ///< of the Unix socket's file, to be removed
};

}  // namespace meniscus::server
