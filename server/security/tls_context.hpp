// TLS of the HTTP port, with certificates that can be replaced while connections live.
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <mutex>

#include "security/certificates.hpp"

namespace meniscus::server {

class TlsContext {
public:
    explicit TlsContext(const Certificates& certificates);

    /// For connections from now on. Throws InvalidInput, and changes nothing, for certificates that OpenSSL refuses.
    void replace(const Certificates& certificates);
    /// The context for one connection.
    std::shared_ptr<boost::asio::ssl::context> current() const;
    /// Whether calls need a client's certificate; pages and probes do not.
    bool mutual() const noexcept { return mutual_; }

private:
    const bool mutual_;
    mutable std::mutex mutex_;  ///< for what follows
    std::shared_ptr<boost::asio::ssl::context> current_;
};

}  // namespace meniscus::server
