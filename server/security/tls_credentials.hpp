// TLS of the gRPC port, with certificates that can be replaced while connections live.
#pragma once

#include <grpc/grpc_security.h>
#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <mutex>
#include <string>

#include "security/certificates.hpp"

namespace meniscus::server {

/// For one port. gRPC asks for the certificates at every handshake; connections that exist keep those that they began
/// with. (grpc::experimental::FileWatcherCertificateProvider would take a damaged file over, and then refuse every
/// connection.) Must outlive the server.
class TlsCredentials final : public grpc::ServerCredentials {
public:
    /// These certificates decide, for good, whether clients need one.
    explicit TlsCredentials(Certificates certificates);

    /// Replaces the certificates for connections from now on.
    void replace(Certificates certificates);

    /// Not used: tokens are checked by the authorizer, with and without TLS.
    void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>& /*processor*/) override {}

private:
    int AddPortToServer(const std::string& address, grpc_server* server) override;
    static grpc_ssl_certificate_config_reload_status fetch(void* self,
                                                           grpc_ssl_server_certificate_config** config) noexcept;

    std::mutex mutex_;  ///< for what follows
    Certificates certificates_;
    bool fetched_ = false;  ///< gRPC has them
};

}  // namespace meniscus::server
