// How to reach a server.
#pragma once

#include <chrono>
#include <stop_token>
#include <string>

#include "meniscus/described.hpp"

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

    template <class Visit>
    static void rows(const Visit& visit) {
        using C = ConnectionOptions;
        visit("ca_file", &C::ca_file, {.help = "TLS: certificates of the authorities to trust", .option = "tls-ca"});
        visit("certificate_file", &C::certificate_file,
              {.help = "mutual TLS: this client's certificate", .option = "tls-cert"});
        visit("key_file", &C::key_file, {.help = "key of that certificate", .option = "tls-key"});
        visit("server_name", &C::server_name,
              {.help = "name in the server's certificate, if not the address's host", .option = "tls-server-name"});
        visit("token", &C::token, {.help = "token to call with"});
        visit("insecure", &C::insecure, {.help = "let the token travel to another machine without TLS"});
        visit("timeout", &C::timeout, {.help = "time to wait for an answer", .unit = "s"});
        visit("wait", &C::wait, {.help = "time to wait for a server that is still starting", .unit = "s"});
    }
};

}  // namespace meniscus::client
