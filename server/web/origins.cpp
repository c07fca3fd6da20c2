#include "web/origins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::server {

namespace {

/// "HOST:PORT" of "SCHEME://HOST:PORT"; empty if it is none.
std::string_view authority_of(std::string_view origin) {
    for (const std::string_view scheme : {"http://", "https://"})
        if (origin.starts_with(scheme)) return origin.substr(scheme.size());
    return {};
}

bool is_loopback(std::string_view authority) {
    for (const std::string_view host : {"localhost", "127.0.0.1", "[::1]"}) {
        if (!authority.starts_with(host)) continue;
        const std::string_view rest = authority.substr(host.size());
        if (rest.empty() || rest.front() == ':') return true;
    }
    return false;
}

}  // namespace

AllowedOrigins::AllowedOrigins(std::vector<std::string> allowed) : allowed_(std::move(allowed)) {
    for (const std::string& origin : allowed_) {
        const std::string_view authority = authority_of(origin);
        if (authority.empty() || authority.find_first_of("/*, ") != std::string_view::npos)
            throw InvalidInput(fmt::format("--web-origin is \"{}\"; it must be as https://example.org or https://example.org:8443", origin));
    }
}

bool AllowedOrigins::admits(std::string_view origin, std::string_view host) const {
    if (origin.empty()) return true;
    const std::string_view authority = authority_of(origin);
    if (authority.empty()) return false;
    return authority == host || is_loopback(authority) || std::ranges::find(allowed_, origin) != allowed_.end();
}

}  // namespace meniscus::server
