// Which web pages may call the server from a browser.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus::server {

class AllowedOrigins {
public:
    /// allowed: as "https://example.org"; pages of this machine and of the server itself need not be named. Throws
    /// InvalidInput for what is no origin.
    explicit AllowedOrigins(std::vector<std::string> allowed);
    AllowedOrigins() = default;

    /// origin: as the browser sends it; empty: no browser asks. host: the request's.
    bool admits(std::string_view origin, std::string_view host) const;

private:
    std::vector<std::string> allowed_;
};

}  // namespace meniscus::server
