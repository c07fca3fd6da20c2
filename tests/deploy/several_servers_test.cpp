// Three servers behind a real proxy: simulator and watcher meet on one of them, also when a server goes and comes back.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <future>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <thread>

#include "meniscus/error.hpp"
#include "played_session.hpp"
#include "process.hpp"
#include "proxy.hpp"
#include "slowness.hpp"
#include "tcp_proxy.hpp"

namespace meniscus::server::test {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t milliseconds(Clock::duration duration) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(duration).count();
}

/// A server that can be killed and started again with its addresses.
class ServerProcess {
public:
    ServerProcess() { start("0", "0"); }
    ~ServerProcess() { end(SIGKILL); }
    ServerProcess(const ServerProcess&) = delete;
    ServerProcess& operator=(const ServerProcess&) = delete;

    void start_again() { start(port_of(address_), port_of(http_)); }
    /// Returns all that it has said.
    std::string end(int signal) {
        if (process_) {
            process_->signal(signal);
            reading_.join();
            process_.reset();
        }
        return log_;
    }

    const std::string& address() const { return address_; }
    const std::string& http_address() const { return http_; }
    std::vector<client::SessionInfo> sessions() const {
        return client::Client(address_, {.wait = std::chrono::seconds(30)}).sessions();
    }

private:
    void start(const std::string& port, const std::string& http_port) {
        // Room for all sessions on the servers that are left.
        process_.emplace(std::vector<std::string>{"--listen", "127.0.0.1:" + port, "--http", "127.0.0.1:" + http_port,
                                                  "--threads", "1", "--backend", "cpu", "--max-sessions", "64",
                                                  "--trusted-proxies", "127.0.0.1"});
        address_ = process_->address();
        http_ = process_->http_address();
        reading_ = std::thread([this] { log_ += process_->rest(); });
    }

    std::optional<Process> process_;
    std::thread reading_;
    std::string address_;
    std::string http_;
    std::string log_;
};

class SeveralServers : public testing::TestWithParam<ProxyKind> {
protected:
    void SetUp() override {
        if (::access(Proxy::program(GetParam()), X_OK) != 0)
            GTEST_SKIP() << Proxy::program(GetParam()) << " is not there";
        proxy.emplace(GetParam(), std::map<std::string, std::string>{{"50051", port_of(servers[0].address())},
                                                                     {"50052", port_of(servers[1].address())},
                                                                     {"50053", port_of(servers[2].address())},
                                                                     {"9464", port_of(servers[0].http_address())},
                                                                     {"9465", port_of(servers[1].http_address())},
                                                                     {"9466", port_of(servers[2].http_address())}});
    }

    client::Client connect() const { return client::Client(proxy->address(), {.wait = std::chrono::seconds(30)}); }

    std::array<ServerProcess, 3> servers;
    std::optional<Proxy> proxy;
};

class Sessions : public SeveralServers {
protected:
    // The proxy passes a server over that does not answer within a second; all of them share this machine.
    static constexpr std::size_t count = slowness > 1.0 ? 18 : 30;

    void begin() {
        for (std::size_t i = 0; i < count; ++i) sessions.emplace_back(proxy->address());
        for (PlayedSession& session : sessions) ASSERT_TRUE(session.when_all_have(3)) << session.state();
    }

    /// The server of each, once it is uploaded to and watched there, and is on no other.
    std::map<std::string, std::size_t> places() const {
        std::map<std::string, std::size_t> result;
        std::size_t there = 0;
        const auto guard = Clock::now() + std::chrono::seconds(30);
        do {
            result.clear();
            there = 0;
            for (std::size_t i = 0; i < servers.size(); ++i)
                for (const client::SessionInfo& session : servers[i].sessions()) {
                    ++there;
                    if (session.uploading && session.watchers == 1) result.emplace(session.id, i);
                }
        } while ((there != count || result.size() != count) && Clock::now() < guard);
        EXPECT_EQ(there, count);
        EXPECT_EQ(result.size(), count);
        return result;
    }

    std::deque<PlayedSession> sessions;
};

/// Whether all sessions with these ids are uploaded to on the server.
bool has_all(const ServerProcess& server, const std::set<std::string>& ids) {
    const auto there = server.sessions();
    return std::ranges::count_if(there, [&](const auto& session) {
               return session.uploading && ids.contains(session.id);
           }) == static_cast<std::ptrdiff_t>(ids.size());
}

/// The longest time that a new watcher waits for a frame, from now until `stop`.
Clock::duration longest_way_to_a_frame(const std::string& address, const std::string& id,
                                       const std::atomic<bool>& stop) {
    constexpr std::chrono::seconds patience(30);
    Clock::duration longest{};
    client::Client client(address);
    while (!stop) {
        const auto start = Clock::now();
        for (;;) try {
                const auto frame = client.watch(id).next(patience);
                if (!frame && !frame.ended)
                    ADD_FAILURE() << "a watcher of " << id << " has seen nothing for " << milliseconds(patience)
                                  << " ms: is it where nobody uploads?";
                if (frame || !frame.ended) break;
            } catch (const client::ServerError&) {
                if (stop) return longest;
                std::this_thread::sleep_for(
                    std::chrono::milliseconds(20));  // the next attempt of a person, or of a page
            }
        longest = std::max(longest, Clock::now() - start);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return longest;
}

int lines_with(const std::string& log, const std::string& id, const std::string& words) {
    int lines = 0;
    for (std::size_t at = 0; at < log.size();) {
        const std::size_t end = std::min(log.find('\n', at), log.size());
        const std::string line = log.substr(at, end - at);
        if (line.find(id) != std::string::npos && line.find(words) != std::string::npos) ++lines;
        at = end + 1;
    }
    return lines;
}

TEST_P(Sessions, GoOnElsewhereWhenTheirServerIsKilledAndComeBackWithItWhileOthersNoticeNothing) {
    ASSERT_NO_FATAL_FAILURE(begin());
    const auto before = places();
    std::array<std::size_t, 3> spread{};
    for (const auto& [id, server] : before) ++spread[server];
    std::cout << "sessions on the servers: " << spread[0] << ", " << spread[1] << ", " << spread[2] << std::endl;
    for (const std::size_t sessions_there : spread) EXPECT_GT(sessions_there, 0U);

    std::set<std::string> moved;
    for (PlayedSession& session : sessions) {
        if (before.at(session.id()) != 0) continue;
        moved.insert(session.id());
        session.stop_waiting_for_the_watcher();
    }
    servers[0].end(SIGKILL);
    const auto killed = Clock::now();
    std::map<std::string, std::uint64_t> pushed;
    for (const PlayedSession& session : sessions) pushed[session.id()] = session.pushed();
    Clock::duration longest{};
    for (PlayedSession& session : sessions) {
        const auto there = session.when_all_have(pushed[session.id()]);
        ASSERT_TRUE(there) << session.state();
        if (moved.contains(session.id())) longest = std::max(longest, *there - killed);
    }
    std::cout << "from the kill to the first new frame of the last of its sessions, its watcher included: "
              << milliseconds(longest) << " ms" << std::endl;
    EXPECT_LT(longest, std::chrono::seconds(10));
    for (const std::size_t i : {1U, 2U})
        for (const client::SessionInfo& session : servers[i].sessions())
            EXPECT_TRUE(session.settings == in_force(settings())) << session.id;

    servers[0].start_again();
    const auto back = Clock::now();
    std::atomic<bool> all_back{false};
    std::deque<Clock::duration> ways(moved.size());
    std::vector<std::thread> comers;
    comers.reserve(moved.size());
    auto way = ways.begin();
    for (const std::string& id : moved)
        comers.emplace_back(
            [&, id, &longest_way = *way++] { longest_way = longest_way_to_a_frame(proxy->address(), id, all_back); });
    while (!has_all(servers[0], moved) && Clock::now() - back < std::chrono::seconds(60))
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto returned = Clock::now() - back;
    all_back = true;
    for (std::thread& comer : comers) comer.join();
    std::cout << "from its return until it has all of them again: " << milliseconds(returned)
              << " ms; longest way of a new watcher to a frame: " << milliseconds(*std::ranges::max_element(ways))
              << " ms\n";
    EXPECT_LT(returned, std::chrono::seconds(10));
    for (PlayedSession& session : sessions) ASSERT_TRUE(session.when_all_have(session.pushed() + 2)) << session.state();
    EXPECT_EQ(places(), before);

    for (PlayedSession& session : sessions) {
        session.finish();
        EXPECT_TRUE(session.errors().empty()) << session.state();
        std::vector<std::uint64_t> all(session.pushed());
        std::iota(all.begin(), all.end(), 0U);
        EXPECT_EQ(session.received(), all) << session.id();
        const std::vector<std::uint64_t> shown = session.shown();
        EXPECT_TRUE(std::ranges::adjacent_find(shown, std::greater_equal<>()) == shown.end())
            << session.id() << " was shown a frame again";
        EXPECT_TRUE(moved.contains(session.id()) || shown == all) << session.id() << " missed a frame";
    }
    for (std::size_t i = 1; i < servers.size(); ++i) {
        const std::string log = servers[i].end(SIGTERM);
        for (const auto& [id, server] : before)
            if (server == i) {
                EXPECT_EQ(lines_with(log, id, "stream from"), 2) << "opened and closed, " << id;
                EXPECT_EQ(lines_with(log, id, "connected"), 1) << id;
            }
    }
}

TEST_P(SeveralServers, AreWatchedWhereTheSimulatorGoesThoughItsConnectionBreaksOnceTheRingHasChanged) {
    TcpProxy way(static_cast<std::uint16_t>(std::stoi(port_of(proxy->address()))));
    client::Client simulator(way.address(), {.wait = std::chrono::seconds(30)});
    auto near = connect();
    std::string id;
    do {
        id = client::new_session_id();
        near.create_session(id, settings());
    } while (!std::ranges::any_of(servers[0].sessions(), [&](const auto& session) { return session.id == id; }));
    // It goes where its calls go once its connection is broken, and not before.
    auto stream =
        simulator.stream(id, {.reconnect = std::chrono::seconds(60), .route_check = std::chrono::milliseconds(0)});
    auto watcher = near.watch(id, {.reconnect = std::chrono::seconds(60)});
    const Particles particles = wave(3, 0.0);
    const auto is_shown = [&](std::uint64_t index) {
        auto shown = std::async(std::launch::async, [&] { return watcher.next(); });
        stream.push(particles.view(), index, 0.0);
        EXPECT_EQ(stream.next()->index, index);
        const bool in_time = shown.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
        if (!in_time) watcher.cancel();
        const auto frame = shown.get();
        return in_time && frame && frame->index == index;
    };
    ASSERT_TRUE(is_shown(0));
    servers[0].end(SIGKILL);
    ASSERT_TRUE(is_shown(1));
    servers[0].start_again();
    const auto found = [&] {
        try {
            near.session(id);
            return true;
        } catch (const client::ServerError&) {
            return false;
        }
    };
    while (found()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    way.cut();
    EXPECT_TRUE(is_shown(2));
    EXPECT_TRUE(has_all(servers[0], {id}));
}

TEST_P(SeveralServers, AnswerThroughTheProxyInTheirOwnWords) {
    auto near = connect();
    const std::string id = client::new_session_id();
    try {
        near.session(id);
        FAIL();
    } catch (const client::ServerError& error) {
        EXPECT_EQ(error.status(), "NOT_FOUND");
        EXPECT_NE(std::string(error.what()).find("no session " + id), std::string::npos) << error.what();
    }
    auto watcher = near.watch(id, {.reconnect = std::chrono::seconds(60)});
    const auto refused = std::async(std::launch::async, [&] { EXPECT_THROW(watcher.next(), client::ServerError); });
    EXPECT_EQ(refused.wait_for(std::chrono::seconds(10)), std::future_status::ready)
        << "tried again, as if there had been a session";
    watcher.cancel();
    near.create_session(id, settings());
    auto stream = near.stream(id);
    Particles bad = wave(3, 0.0);
    bad.positions[5] = std::numeric_limits<float>::infinity();
    stream.push(wave(3, 0.0).view(), 0, 0.0);
    stream.push(bad.view(), 1, 0.0);
    EXPECT_EQ(stream.next()->index, 0U);
    EXPECT_THROW(stream.next(), InvalidInput);
}

TEST_P(SeveralServers, NameTheClientsOfTheProxyInTheirLogs) {
    client::Client client = connect();
    const std::string id = client::new_session_id();
    client.create_session(id, settings());
    client::Stream stream = client.stream(id);
    stream.finish();
    EXPECT_FALSE(stream.next());
    client.delete_session(id);
    std::string logs;
    for (ServerProcess& server : servers) logs += server.end(SIGTERM);
    EXPECT_NE(logs.find("stream from 127.0.0.1 through ipv4:127.0.0.1:"), std::string::npos) << logs;
}

TEST_P(SeveralServers, AnswerCallsAboutNoSessionFromOneOfThem) {
    for (std::size_t i = 0; i < servers.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            client::Client(servers[i].address()).create_session(client::new_session_id(), settings());
    auto near = connect();
    const std::size_t there = near.sessions().size();
    for (int i = 0; i < 6; ++i) EXPECT_EQ(near.sessions().size(), there);
}

TEST_P(SeveralServers, TakeLargeFramesAndSendLargeMeshesAtATime) {
    auto near = connect();
    const std::string id = client::new_session_id();
    near.create_session(id, settings());
    auto stream = near.stream(id);
    const Particles particles = spray(24);  // drops apart from each other: more bytes come back than go
    constexpr std::uint64_t frames = 6;
    std::thread pushing([&] {
        for (std::uint64_t i = 0; i < frames; ++i) stream.push(particles.view(), i, 0.0);
        stream.finish();
    });
    std::uint64_t received = 0;
    while (const auto frame = stream.next()) EXPECT_EQ(frame->index, received++);
    pushing.join();
    EXPECT_EQ(received, frames);
}

std::string name_of(const testing::TestParamInfo<ProxyKind>& info) {
    return info.param == ProxyKind::nginx ? "Nginx" : "HAProxy";
}

INSTANTIATE_TEST_SUITE_P(Behind, SeveralServers, testing::Values(ProxyKind::nginx, ProxyKind::haproxy), name_of);
INSTANTIATE_TEST_SUITE_P(Behind, Sessions, testing::Values(ProxyKind::nginx, ProxyKind::haproxy), name_of);

}  // namespace
}  // namespace meniscus::server::test
