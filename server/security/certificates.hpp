// The server's certificate, its key, and the authority whose clients it trusts: PEM files.
#pragma once

#include <cstdint>
#include <string>

#include "meniscus/described.hpp"

namespace meniscus::server {

struct TlsFiles {
    std::string certificate;  ///< the chain, the server's own first
    std::string key;
    std::string client_ca;  ///< empty: clients need no certificate

    /// Whether TLS is asked for.
    bool any() const { return !certificate.empty() || !key.empty() || !client_ca.empty(); }

    /// Calls visit(name, value, facts) for each file.
    template <class Self, class Visit>
    static void rows(Self& self, const Visit& visit) {
        visit("tls_cert", self.certificate, {.help = "Certificate chain for TLS, PEM", .argument = "FILE"});
        visit("tls_key", self.key, {.help = "Its key, PEM", .argument = "FILE"});
        visit("tls_client_ca", self.client_ca,
              {.help = "Mutual TLS: clients need a certificate of one of these, PEM", .argument = "FILE"});
    }
};

/// The files' contents.
struct Certificates {
    std::string chain;
    std::string key;
    std::string client_ca;

    bool operator==(const Certificates&) const = default;
};

/// Throws InvalidInput that names the file and what is wrong: not PEM, expired or not valid yet, a key of another
/// certificate or one that asks for a pass phrase.
Certificates load_certificates(const TlsFiles& files);

/// The time when the first of these PEM certificates, which have been loaded, expires: seconds since 1970-01-01 UTC.
std::int64_t first_expiry(const std::string& pem);

/// "serial 0A1B, valid until Nov 21 08:00:00 2027 GMT", of certificates that have been loaded.
std::string describe(const Certificates& certificates);

}  // namespace meniscus::server
