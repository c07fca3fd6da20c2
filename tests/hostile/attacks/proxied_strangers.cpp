// Attacks on HTTP/2 that gRPC 1.51 does not withstand, through the shipped HAProxy and nginx (D3).
#include <unistd.h>

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>

#include "../../deploy/http2_attack.hpp"
#include "../../deploy/proxy.hpp"
#include "../attacks.hpp"
#include "../target.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

namespace {

using server::test::Http2Attack;
using server::test::Proxy;
using server::test::ProxyKind;

constexpr std::size_t resets = 600'000;
constexpr std::size_t header_bytes = std::size_t{20} << 20;

Proxy proxy_of(ProxyKind kind, const Target& target) {
    if (::access(Proxy::program(kind), X_OK) != 0)
        throw std::runtime_error(std::string(Proxy::program(kind)) + " is not there");
    std::map<std::string, std::string> ports;
    for (const char* port : {"50051", "50052", "50053"}) ports[port] = server::test::port_of(target.address());
    for (const char* port : {"9464", "9465", "9466"}) ports[port] = server::test::port_of(target.http_address());
    return {kind, std::move(ports)};
}

/// Processor time of the server, seconds, for resets on `connections`, one after the other.
double seconds_of_resets(ProxyKind kind, const std::string& program, std::size_t connections) {
    const Target target(program);
    const Proxy proxy = proxy_of(kind, target);
    const client::ConnectionOptions patient{.wait = std::chrono::seconds(30)};
    client::Client(proxy.address(), patient).server_info();
    const double before = target.processor_seconds();
    // nginx ends connections earlier than that: then there are more of them.
    std::size_t sent = 0;
    for (std::size_t i = 0; sent < resets && i < 100 * connections; ++i)
        sent += Http2Attack(proxy.address()).begin_and_reset(resets / connections);
    client::Client(target.address()).server_info();
    return target.processor_seconds() - before;
}

double seconds_of_headers(ProxyKind kind, const std::string& program) {
    const Target target(program);
    const Proxy proxy = proxy_of(kind, target);
    client::Client(proxy.address(), {.wait = std::chrono::seconds(30)}).server_info();
    const double before = target.processor_seconds();
    for (const bool one : {true, false}) Http2Attack(proxy.address()).endless_headers(header_bytes, one);
    client::Client(proxy.address(), {.wait = std::chrono::seconds(30)}).server_info();
    return target.processor_seconds() - before;
}

}  // namespace

std::vector<Figure> proxied_strangers(const std::string& program) {
    constexpr double limit = 1.0;
    return {{"server's processor time, resets in one connection, HAProxy",
             seconds_of_resets(ProxyKind::haproxy, program, 1), limit, "s"},
            {"the same in 600 connections", seconds_of_resets(ProxyKind::haproxy, program, 600), limit, "s"},
            {"the same, nginx", seconds_of_resets(ProxyKind::nginx, program, 600), limit, "s"},
            {"headers without an end, HAProxy", seconds_of_headers(ProxyKind::haproxy, program), limit, "s"},
            {"headers without an end, nginx", seconds_of_headers(ProxyKind::nginx, program), limit, "s"}};
}

}  // namespace meniscus::hostile
