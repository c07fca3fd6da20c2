// How to reach a server.
#pragma once

#include <chrono>
#include <stop_token>
#include <string>

namespace meniscus::client {

/// How to connect, and as whom. Files are PEM.
struct ConnectionOptions {
    std::string ca_file = {};           ///< TLS: whose certificates to trust; empty: no TLS
    std::string certificate_file = {};  ///< mutual TLS, with key_file: this client's own
    std::string key_file = {};
    std::string server_name = {};  ///< in the server's certificate; empty: the address's host
    std::string token = {};        ///< sent with every call
    bool insecure = false;         ///< whether a token may travel to another machine without TLS
    /// How long to wait for a host that does not answer: for the connection, and in each call of Client for its answer.
    /// A refused connection is reported at once; see `wait`.
    std::chrono::milliseconds timeout = std::chrono::seconds(10);
    /// For how long a refused connection is tried again, since the server may still be starting.
    std::chrono::milliseconds wait = std::chrono::milliseconds(0);
    std::stop_token stop{};  ///< when a stop is requested, the attempt to connect ends: ServerError (canceled)
};

}  // namespace meniscus::client
