// Strangers in front of the proxies that are shipped: the servers behind them do not notice.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "http2_attack.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/reconstructor.hpp"
#include "played_session.hpp"
#include "process.hpp"
#include "proxy.hpp"
#include "slowness.hpp"

namespace meniscus::server::test {
namespace {

/// Seconds of processor time that the process has taken.
double processor_seconds(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string text;
    std::getline(file, text);
    std::istringstream words(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) words >> skipped;
    double user = 0.0;
    double system = 0.0;
    words >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

class Strangers : public testing::TestWithParam<ProxyKind> {
protected:
    void SetUp() override {
        if (::access(Proxy::program(GetParam()), X_OK) != 0)
            GTEST_SKIP() << Proxy::program(GetParam()) << " is not there";
        server.emplace(std::vector<std::string>{"--listen", "127.0.0.1:0", "--http", "127.0.0.1:0", "--threads", "1",
                                                "--backend", "cpu", "--max-sessions", "256"});
        const std::string address = server->address();
        const std::string http = server->http_address();
        std::map<std::string, std::string> ports;
        for (const char* port : {"50051", "50052", "50053"}) ports[port] = port_of(address);
        for (const char* port : {"9464", "9465", "9466"}) ports[port] = port_of(http);
        proxy.emplace(GetParam(), ports);
        client.emplace(proxy->address(), client::ConnectionOptions{.wait = std::chrono::seconds(30)});
        EXPECT_EQ(client->server_info().version, version());
    }

    std::optional<Process> server;
    std::optional<Proxy> proxy;
    std::optional<client::Client> client;
};

INSTANTIATE_TEST_SUITE_P(Behind, Strangers, testing::Values(ProxyKind::haproxy, ProxyKind::nginx),
                         [](const auto& kind) { return kind.param == ProxyKind::nginx ? "nginx" : "HAProxy"; });

TEST_P(Strangers, WhoResetTheirCallsCostTheServerNothing) {
    const double before = processor_seconds(server->pid());
    std::size_t sent = 0;
    for (int connection = 0; connection < 8; ++connection)
        sent += Http2Attack(proxy->address()).begin_and_reset(15'000);
    EXPECT_GT(sent, 0U);
    // Behind what the attack has left in the proxy's queues.
    EXPECT_EQ(client->sessions().size(), 0U);
    const double taken = processor_seconds(server->pid()) - before;
    std::printf("%zu resets in 8 connections: %.2f s of the server's processor time\n", sent, taken);
    EXPECT_LT(taken, slowness * 5.0 * 120'000 / 600'000);
}

TEST_P(Strangers, WhoseHeadersHaveNoEndDoNotReachTheServer) {
    constexpr std::size_t bytes = std::size_t{20} << 20;
    const double before = processor_seconds(server->pid());
    for (const bool one : {true, false}) EXPECT_LT(Http2Attack(proxy->address()).endless_headers(bytes, one), bytes);
    EXPECT_EQ(client->server_info().version, version());
    EXPECT_LT(processor_seconds(server->pid()) - before, 1.0);
}

TEST_P(Strangers, AreNotAHundredClientsOfOneMachine) {
    struct User {
        explicit User(const std::string& address) : client(address), id(client::new_session_id()) {}
        client::Client client;
        std::string id;
        std::optional<client::Stream> stream;
        std::optional<client::Watcher> watcher;
    };
    std::vector<std::unique_ptr<User>> users;
    for (int i = 0; i < 100; ++i) {
        User& user = *users.emplace_back(std::make_unique<User>(proxy->address()));
        user.client.create_session(user.id, settings());
        user.stream = user.client.stream(user.id);
        user.watcher = user.client.watch(user.id);
    }
    const Particles particles = wave(3, 0.0);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        for (const auto& user : users) user->stream->push(particles.view(), frame, 0.0);
        for (const auto& user : users) EXPECT_EQ(user->stream->next()->index, frame);
    }
    for (const auto& user : users) EXPECT_TRUE(user->watcher->next());
    EXPECT_EQ(client->sessions().size(), 100U);
}

TEST_P(Strangers, AreNotTwentyStreamsOfOneClient) {
    const std::size_t streams = 20;
    std::vector<std::string> ids;
    std::vector<client::Stream> open;
    std::vector<client::Watcher> watchers;
    for (std::size_t i = 0; i < streams; ++i) {
        ids.push_back(client::new_session_id());
        client->create_session(ids.back(), settings());
        open.push_back(client->stream(ids.back()));
        watchers.push_back(client->watch(ids.back()));
    }
    for (std::uint64_t frame = 0; frame < 5; ++frame)
        for (std::size_t i = 0; i < streams; ++i) {
            const Particles particles = wave(6, static_cast<double>(frame));
            open[i].push(particles.view(), frame, 0.0);
            EXPECT_EQ(open[i].next()->index, frame);
        }
    for (client::Watcher& watcher : watchers) EXPECT_TRUE(watcher.next());
}

}  // namespace
}  // namespace meniscus::server::test
