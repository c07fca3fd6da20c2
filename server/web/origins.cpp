#include "web/origins.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <system_error>
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

/// The host without the port, in lower case; an IPv6 address without its brackets.
std::string host_of(std::string_view authority) {
    if (authority.starts_with('[')) return std::string(authority.substr(1, authority.find(']') - 1));
    std::string host(authority.substr(0, authority.rfind(':')));
    std::ranges::transform(host, host.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return host;
}

bool is_address(const std::string& host) {
    in6_addr any{};
    return ::inet_pton(AF_INET, host.c_str(), &any) == 1 || ::inet_pton(AF_INET6, host.c_str(), &any) == 1;
}

bool is_loopback(std::string_view authority) {
    const std::string host = host_of(authority);
    return host == "localhost" || host == "127.0.0.1" || host == "::1";
}

/// "HOST" or "HOST:PORT" in the characters that an origin has; an IPv6 address in brackets.
bool is_authority(std::string_view authority) {
    std::string_view host = authority;
    std::string_view port;
    const std::size_t bracket = authority.starts_with('[') ? authority.find(']') : 0;
    if (bracket == std::string_view::npos) return false;
    if (const std::size_t colon = authority.find(':', bracket); colon != std::string_view::npos) {
        host = authority.substr(0, colon);
        port = authority.substr(colon + 1);
        int number = 0;
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
        if (error != std::errc() || end != port.data() + port.size() || number < 1 || number > 65535) return false;
    }
    if (bracket != 0) return host.ends_with(']') && is_address(std::string(host.substr(1, host.size() - 2)));
    return !host.empty() && std::ranges::all_of(host, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
               c == '.';
    });
}

}  // namespace

void require_origin(std::string_view flag, std::string_view origin) {
    if (!is_authority(authority_of(origin)))
        throw InvalidInput(
            fmt::format("{} is \"{}\"; it must be as https://example.org or https://example.org:8443, one origin, no "
                        "pattern and no path",
                        flag, origin));
}

AllowedOrigins::AllowedOrigins(std::vector<std::string> allowed, std::string_view listen)
    : allowed_(std::move(allowed)) {
    for (const std::string& origin : allowed_) {
        require_origin("--web-origin", origin);
        names_.push_back(host_of(authority_of(origin)));
    }
    if (!listen.empty()) names_.push_back(host_of(listen));
}

bool AllowedOrigins::admits(std::string_view origin, std::string_view host) const {
    if (origin.empty()) return true;
    const std::string_view authority = authority_of(origin);
    if (authority.empty()) return false;
    return authority == host || is_loopback(authority) || std::ranges::find(allowed_, origin) != allowed_.end();
}

bool AllowedOrigins::knows_host(std::string_view host) const {
    const std::string name = host_of(host);
    return name.empty() || name == "localhost" || is_address(name) || std::ranges::find(names_, name) != names_.end();
}

std::vector<std::pair<std::string, std::string>> cross_origin_headers(std::string_view origin) {
    if (origin.empty()) return {};
    return {
        {"Access-Control-Allow-Origin", std::string(origin)},
        {"Access-Control-Expose-Headers", "grpc-status, grpc-message, content-range, etag, x-codec, x-codec-reason"},
        {"Vary", "Origin"}};
}

}  // namespace meniscus::server
