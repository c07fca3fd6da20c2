// Which web pages may call the server from a browser, and under which names it is known.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meniscus::server {

class AllowedOrigins {
public:
    /// allowed: as "https://example.org"; pages of this machine and of the server itself need not be named. listen: the
    /// server's "HOST:PORT". Throws InvalidInput for what is no origin.
    explicit AllowedOrigins(std::vector<std::string> allowed, std::string_view listen = {});
    AllowedOrigins() = default;

    /// origin: as the browser sends it; empty: no browser asks. host: the request's, which the server is known by.
    bool admits(std::string_view origin, std::string_view host) const;
    /// Whether a request for this host ("HOST:PORT", "HOST", or empty: none was named) can be meant for this server: by
    /// address, as localhost, or by a name that it was given. Any other name may be an attacker's, whose DNS leads a
    /// browser to this machine for its own page (DNS rebinding).
    bool knows_host(std::string_view host) const;

private:
    std::vector<std::string> allowed_;
    std::vector<std::string> names_;  ///< hosts of them, and the server's own
};

/// Throws InvalidInput, with the flag's name, for what is no origin: SCHEME://HOST or SCHEME://HOST:PORT, and nothing
/// more. A host that is not of ASCII is written as browsers send it (xn--...).
void require_origin(std::string_view flag, std::string_view origin);

/// The headers that let a page of that origin, which is admitted, read an answer; none for an empty one.
std::vector<std::pair<std::string, std::string>> cross_origin_headers(std::string_view origin);

}  // namespace meniscus::server
