// The program while strangers take all of its connections, and after they have gone.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "connections/attack_sockets.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/reconstructor.hpp"
#include "observation/metrics.hpp"
#include "process.hpp"
#include "test_certificates.hpp"

namespace meniscus::server::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t descriptors = 1024;
/// The connections of each attack: a few more and many more than the server's descriptors.
constexpr std::size_t attacks[] = {1100, 5000};

/// Seconds until the gRPC port, the HTTP port and that of probes serve.
double seconds_until_served(const std::string& address, const std::string& http, const std::string& probes,
                            const client::ConnectionOptions& options = {}) {
    const auto begin = Clock::now();
    for (;;) {
        try {
            EXPECT_EQ(client::Client(address, options).server_info().version, version());
            break;
        } catch (const client::ServerError&) {
            if (Clock::now() - begin > std::chrono::seconds(60)) throw;
        }
    }
    EXPECT_EQ(http_get(http, "/readyz").status, 200);
    EXPECT_EQ(http_get(probes, "/healthz").status, 200);
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Waits until the server has noticed that all connections are closed.
void wait_for_room(const std::string& probes) {
    scrape_until(probes, "meniscus_connections", 0);
}

class FullServer : public testing::Test {
protected:
    FullServer() {
        rlimit limit{};
        ::getrlimit(RLIMIT_NOFILE, &limit);
        limit.rlim_cur = limit.rlim_max;
        ::setrlimit(RLIMIT_NOFILE, &limit);
    }
};

TEST_F(FullServer, IsAliveAndServesAgainOnceTheStrangersHaveGone) {
    Process process(on_free_port({"--http", "127.0.0.1:0", "--probes", "127.0.0.1:0"}), descriptors);
    const std::string address = process.address();
    const std::string http = process.http_address();
    const std::string probes = process.http_address();
    double slowest = 0.0;
    for (const std::size_t attack : attacks) {
        {
            const AttackSockets to_grpc(address, attack);
            const AttackSockets to_http(http, attack / 4);
            EXPECT_EQ(to_grpc.size(), attack);
            EXPECT_EQ(http_get(http, "/healthz").status, 200);
            // A check or two of the port have been made by then.
            const auto later = Clock::now() + std::chrono::seconds(2);
            while (Clock::now() < later) {
                EXPECT_EQ(http_get(probes, "/healthz").status, 200);
                EXPECT_EQ(http_get(probes, "/readyz").status, 200);
            }
            const Samples samples = scrape(probes);
            EXPECT_LT(samples.at("meniscus_connections"), descriptors);
            EXPECT_GT(samples.at("meniscus_connections_refused_total{limit=\"connections\"}"), 0);
        }
        slowest = std::max(slowest, seconds_until_served(address, http, probes));
        wait_for_room(probes);
    }
    std::printf("all ports served again after %.2f s at most\n", slowest);
    EXPECT_LT(slowest, 5.0);
    process.signal(SIGTERM);
    const std::string log = process.rest();
    EXPECT_EQ(process.exit_code(), 0);
    EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 40) << log;
    EXPECT_NE(log.find("--max-connections"), std::string::npos) << log;
}

TEST_F(FullServer, ServesAgainWithTls) {
    const TestCertificates certificates;
    Process process(on_free_port({"--probes", "127.0.0.1:0", "--http", "127.0.0.1:0", "--tls-cert",
                                  certificates.file("server"), "--tls-key", certificates.key("server")}),
                    descriptors);
    const std::string address = process.address();
    const std::string probes = process.http_address();
    { const AttackSockets strangers(address, attacks[0]); }
    const auto begin = Clock::now();
    EXPECT_EQ(client::Client(address, {.ca_file = certificates.file("ca")}).server_info().version, version());
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 5.0);
    EXPECT_EQ(http_get(probes, "/healthz").status, 200);
}

TEST_F(FullServer, RaisesItsSoftLimitOfDescriptors) {
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit low = before;
    low.rlim_cur = 256;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
    Process process(on_free_port());
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    process.address();
    rlimit raised{};
    ASSERT_EQ(::prlimit(process.pid(), RLIMIT_NOFILE, nullptr, &raised), 0);
    EXPECT_EQ(raised.rlim_cur, std::min<rlim_t>(raised.rlim_max, 1U << 20U));
}

}  // namespace
}  // namespace meniscus::server::test
