// The gRPC port: accepts connections, bounds their number, and hands them to gRPC. gRPC's own listener would never
// accept again once descriptors have run out (CVE-2023-4785).
#pragma once

#include <grpcpp/server_builder.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "connections/connection_table.hpp"
#include "connections/listening_sockets.hpp"
#include "connections/own_connections.hpp"
#include "connections/received_bytes.hpp"
#include "process/line_limit.hpp"

namespace meniscus::server {

class GrpcPort {
public:
    /// The connections that there are, and those that were refused so far.
    struct Counts {
        std::size_t connections = 0;  ///< that there are now
        std::uint64_t refused_of_all = 0;
        std::uint64_t refused_of_peers = 0;
    };

    /// Listens when it returns; accepts from start() on. Throws as ListeningSockets does.
    GrpcPort(const std::string& address, const ConnectionLimits& limits, TrustedPeers trusted);
    ~GrpcPort();
    GrpcPort(const GrpcPort&) = delete;
    GrpcPort& operator=(const GrpcPort&) = delete;

    /// The address in the form that clients use, with the port that was chosen.
    const std::string& address() const noexcept { return sockets_.address(); }
    const std::vector<int>& sockets() const noexcept { return sockets_.descriptors(); }
    OwnConnections& own_connections() noexcept { return own_; }
    const ReceivedBytesOfPeers& received_bytes() const noexcept { return received_bytes_; }
    Counts counts();

    /// grpc: of a server that has started. Once.
    void start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc);
    /// No connection reaches gRPC after it: call it before the server shuts down.
    void stop();

private:
    void run();
    /// Takes those that wait. False if a pause is needed, for want of descriptors most likely.
    bool accept_all(int socket);
    /// False if none waits, or one cannot be taken.
    bool accept_one(int socket);
    bool admit(int connection, const PeerAddress& peer);

    ListeningSockets sockets_;
    OwnConnections own_;
    ReceivedBytesOfPeers received_bytes_;
    int wake_;  ///< readable once the thread is to end
    std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc_;
    LineLimit refusals_;
    LineLimit failures_;

    std::mutex mutex_;  ///< for what follows
    ConnectionTable table_;
    Counts counts_;

    std::thread thread_;
};

}  // namespace meniscus::server
