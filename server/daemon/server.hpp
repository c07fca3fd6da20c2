// The whole server in one object: sessions, services, and the port.
#pragma once

#include <memory>
#include <string>

#include "meniscus/reconstructor.hpp"
#include "options/server_options.hpp"

namespace meniscus::server {

class RecordingWriter;

class Server {
public:
    /// Listens when it returns. Throws InvalidInput if the backend or the address cannot be used, Unavailable if
    /// another program has the address or the folder of recordings, or this machine has no such address.
    explicit Server(const ServerOptions& options);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// The address in the form that clients use, with the port that was chosen.
    const std::string& address() const noexcept;
    /// The address of the HTTP port; empty if there is none.
    std::string http_address() const;
    /// The address of the port for metrics and probes alone; empty if there is none.
    std::string probes_address() const;
    const BackendDescription& backend() const noexcept;
    /// None if nothing is recorded.
    const RecordingWriter* recordings() const noexcept;

    /// Reads certificates and tokens again, for connections and calls from now on. Logs a file that cannot be used, and
    /// keeps what it had before.
    void reload();

    /// Takes no new frames, answers those in flight, ends the watchers. Calls that are left after the grace period are
    /// canceled.
    void shutdown();

private:
    class Impl;  // gRPC, Boost and the rest stay out of what only starts a server
    const std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::server
