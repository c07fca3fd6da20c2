// More connections than the server has descriptors for, without a token; then they are gone (D1).
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "../../server/connections/attack_sockets.hpp"
#include "../../server/observation/http_client.hpp"
#include "../attacks.hpp"
#include "../target.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::hostile {

namespace {

using Clock = std::chrono::steady_clock;
using server::test::AttackSockets;
using server::test::http_get;

constexpr rlim_t descriptors = 1024;
constexpr int times = 20;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Seconds until a new client has an answer at the gRPC port and at the HTTP port.
double seconds_until_served(const Target& target) {
    const auto begin = Clock::now();
    for (;;) {
        try {
            client::Client(target.address()).server_info();
            break;
        } catch (const client::ServerError&) {
            if (seconds_since(begin) > 60) throw;
        }
    }
    if (http_get(target.http_address(), "/readyz").status != 200) throw std::runtime_error("it is not ready");
    return seconds_since(begin);
}

/// Answers of /healthz, within the time of a check of the port, that the server is dead.
int deaths_while_full(const Target& target) {
    int deaths = 0;
    for (const auto begin = Clock::now(); seconds_since(begin) < 1.5;)
        deaths += http_get(target.http_address(), "/healthz").status == 200 ? 0 : 1;
    return deaths;
}

}  // namespace

std::vector<Figure> connections(const std::string& program) {
    rlimit own{};
    ::getrlimit(RLIMIT_NOFILE, &own);
    own.rlim_cur = own.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &own);
    const Target target(program, {.arguments = {}, .descriptors = descriptors});
    double slowest = 0.0;
    double deaths = 0.0;
    for (int i = 0; i < times; ++i) {
        {
            const std::size_t count = i % 2 == 0 ? 1100 : 5000;
            const AttackSockets strangers(target.address(), count);
            if (strangers.size() != count) throw std::runtime_error("this process may not have 5000 descriptors");
            const AttackSockets readers(target.http_address(), 1000);
            deaths += deaths_while_full(target);
        }
        slowest = std::max(slowest, seconds_until_served(target));
    }
    return {{"until both ports serve again", slowest, 1.0, "s"},
            {"answers of /healthz that the full server is dead", deaths, 0.0, ""}};
}

}  // namespace meniscus::hostile
