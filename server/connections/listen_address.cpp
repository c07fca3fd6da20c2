#include "connections/listen_address.hpp"

#include <fmt/format.h>
#include <sys/un.h>

#include <charconv>

#include "address/loopback.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {

HostPort parse_host_port(std::string_view flag, const std::string& address) {
    if (!address.empty() && address.find_first_not_of("0123456789") == std::string::npos)
        throw InvalidInput(
            fmt::format("{0} {1} has no host: give 127.0.0.1:{1} for this machine alone, or 0.0.0.0:{1} "
                        "for others, too",
                        flag, address));
    const std::size_t colon = address.rfind(':');
    const std::string host = colon == std::string::npos ? "" : address.substr(0, colon);
    const bool in_brackets = host.size() > 2 && host.starts_with('[') && host.ends_with(']');
    if (host.empty() || (!in_brackets && host.find_first_of(":[]/") != std::string::npos))
        throw InvalidInput(fmt::format("{} {} is no address: give HOST:PORT, or [IPv6]:PORT{}", flag, address,
                                       flag == "--listen" ? ", or unix:PATH" : ""));
    unsigned port = 0;
    const char* const end = address.data() + address.size();
    const auto [rest, error] = std::from_chars(address.data() + colon + 1, end, port);
    constexpr unsigned greatest = 65535;
    if (error != std::errc{} || rest != end || port > greatest)
        throw InvalidInput(
            fmt::format("{} {}: the port must be a number from 0 (a free one) to {}", flag, address, greatest));
    return {.host = in_brackets ? host.substr(1, host.size() - 2) : host, .port = static_cast<std::uint16_t>(port)};
}

std::string unix_path(const std::string& address) {
    constexpr std::string_view scheme = "unix:";
    if (!address.starts_with(scheme)) return {};
    std::string path = address.substr(scheme.size());
    if (path.starts_with("//")) path.erase(0, 2);
    constexpr std::size_t longest = sizeof(sockaddr_un::sun_path) - 1;
    if (path.empty() || path.size() > longest)
        throw InvalidInput(fmt::format("cannot listen on {}: the path must have 1 to {} bytes", address, longest));
    return path;
}

void require_listen_address(const std::string& address) {
    if (unix_path(address).empty()) parse_host_port("--listen", address);
}

void require_loopback(std::string_view flag, const std::string& address) {
    if (address::is_loopback(address)) return;
    throw InvalidInput(
        fmt::format("{} {} can be reached from other machines, without TLS: give a loopback address, or --insecure "
                    "if this is meant (--tls-cert and --tls-key give --listen TLS)",
                    flag, address));
}

}  // namespace meniscus::server
