// Certificates and tokens of a running server, and their files.
#pragma once

#include <grpcpp/security/server_credentials.h>

#include <atomic>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "security/authorizer.hpp"
#include "security/certificates.hpp"
#include "security/tls_context.hpp"
#include "security/tls_credentials.hpp"
#include "security/tokens.hpp"

namespace meniscus::server {

class Access {
public:
    /// tokens: a file; empty: every client may do everything. trusted_proxies: peers through which others come. Throws
    /// InvalidInput if one of these cannot be used.
    Access(const TlsFiles& tls, const std::string& tokens, const std::vector<std::string>& trusted_proxies = {});

    const Authorizer& authorizer() const noexcept { return authorizer_; }
    /// The credentials of the gRPC port.
    std::shared_ptr<grpc::ServerCredentials> credentials() const;
    /// The TLS of the HTTP port; none without TLS.
    std::shared_ptr<const TlsContext> http_tls() const { return http_tls_; }

    /// The times when the first certificate in each file expires, seconds since 1970-01-01 UTC; infinite where there is
    /// none. From any thread.
    struct Expiry {
        double server;
        double client_ca;
    };
    Expiry expiry() const noexcept { return {.server = server_expiry_, .client_ca = client_ca_expiry_}; }

    /// Takes over what has changed in the files. Logs a file that cannot be used, and keeps what it had before. One
    /// thread at a time.
    void reload();

private:
    void reload_certificates();
    void note_expiry();
    void reload_tokens();

    const TlsFiles tls_files_;
    const std::string tokens_file_;
    Certificates certificates_;
    Tokens tokens_;
    Authorizer authorizer_;
    std::shared_ptr<TlsCredentials> tls_;   ///< none without TLS
    std::shared_ptr<TlsContext> http_tls_;  ///< none without TLS
    std::string problems_;                  ///< logged already
    std::atomic<double> server_expiry_{std::numeric_limits<double>::infinity()};
    std::atomic<double> client_ca_expiry_{std::numeric_limits<double>::infinity()};
};

}  // namespace meniscus::server
