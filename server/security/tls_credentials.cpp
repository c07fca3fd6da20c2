#include "security/tls_credentials.hpp"

#include <grpc/grpc.h>

#include <utility>

namespace meniscus::server {

TlsCredentials::TlsCredentials(Certificates certificates) : certificates_(std::move(certificates)) {}

void TlsCredentials::replace(Certificates certificates) {
    const std::lock_guard lock(mutex_);
    certificates_ = std::move(certificates);
    fetched_ = false;
}

int TlsCredentials::AddPortToServer(const std::string& address, grpc_server* server) {
    const auto request = certificates_.client_ca.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                                         : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY;
    grpc_server_credentials* credentials = grpc_ssl_server_credentials_create_with_options(
        grpc_ssl_server_credentials_create_options_using_config_fetcher(request, fetch, this));
    const int port = grpc_server_add_http2_port(server, address.c_str(), credentials);
    grpc_server_credentials_release(credentials);
    return port;
}

grpc_ssl_certificate_config_reload_status TlsCredentials::fetch(void* self,
                                                                grpc_ssl_server_certificate_config** config) noexcept {
    auto& credentials = *static_cast<TlsCredentials*>(self);
    const std::lock_guard lock(credentials.mutex_);
    if (std::exchange(credentials.fetched_, true)) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    const Certificates& certificates = credentials.certificates_;
    const grpc_ssl_pem_key_cert_pair pair{.private_key = certificates.key.c_str(),
                                          .cert_chain = certificates.chain.c_str()};
    // gRPC insists on client CAs, also where it asks no client for a certificate and never looks at them.
    const std::string& client_ca = certificates.client_ca.empty() ? certificates.chain : certificates.client_ca;
    *config = grpc_ssl_server_certificate_config_create(client_ca.c_str(), &pair, 1);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
}

}  // namespace meniscus::server
