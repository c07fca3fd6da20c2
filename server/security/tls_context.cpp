#include "security/tls_context.hpp"

#include <fmt/format.h>
#include <openssl/ssl.h>

#include <boost/asio/buffer.hpp>
#include <boost/system/system_error.hpp>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

namespace ssl = boost::asio::ssl;

std::shared_ptr<ssl::context> make_context(const Certificates& certificates) {
    try {
        auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
        context->set_options(ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1 | SSL_OP_NO_RENEGOTIATION);
        // The suites of TLS 1.2 are those that the gRPC port takes: forward secrecy, and encryption that authenticates.
        // TLS 1.3 has nothing else.
        if (SSL_CTX_set_cipher_list(context->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20") != 1)
            throw InvalidInput("this OpenSSL has no suite of ECDHE with AES-GCM or ChaCha20");
        context->use_certificate_chain(boost::asio::buffer(certificates.chain));
        context->use_private_key(boost::asio::buffer(certificates.key), ssl::context::pem);
        // A client that resumes a session shows no certificate again: the session must be of this server.
        constexpr std::string_view name = "meniscusd";
        SSL_CTX_set_session_id_context(context->native_handle(), reinterpret_cast<const unsigned char*>(name.data()),
                                       name.size());
        if (!certificates.client_ca.empty()) {
            context->add_certificate_authority(boost::asio::buffer(certificates.client_ca));
            // One that is shown must be good. None is taken as well: probes have none, and calls are looked at one by
            // one.
            context->set_verify_mode(ssl::verify_peer);
        }
        return context;
    } catch (const boost::system::system_error& error) {
        throw InvalidInput(fmt::format("the HTTP port cannot use the TLS certificate: {}", error.what()));
    }
}

}  // namespace

TlsContext::TlsContext(const Certificates& certificates)
    : mutual_(!certificates.client_ca.empty()), current_(make_context(certificates)) {}

void TlsContext::replace(const Certificates& certificates) {
    auto context = make_context(certificates);
    const std::lock_guard lock(mutex_);
    current_ = std::move(context);
}

std::shared_ptr<boost::asio::ssl::context> TlsContext::current() const {
    const std::lock_guard lock(mutex_);
    return current_;
}

}  // namespace meniscus::server
