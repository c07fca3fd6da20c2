// The events that a caller receives while a connection is broken.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "observation/metrics.hpp"
#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

using namespace std::chrono_literals;

/// Keeps the events, and throws all the same.
struct Listener {
    client::ReconnectHandler handler() {
        return [this](const client::ReconnectEvent& event) {
            const std::lock_guard lock(mutex);
            events.push_back(event);
            throw std::runtime_error("of a handler");
        };
    }

    /// At least one attempt, numbered from 1, then the connection.
    void expect_attempts_and_success() {
        const std::lock_guard lock(mutex);
        ASSERT_GE(events.size(), 2U);
        for (std::size_t i = 0; i + 1 < events.size(); ++i) {
            EXPECT_EQ(events[i].attempt, i + 1);
            EXPECT_FALSE(events[i].connected);
        }
        EXPECT_TRUE(events.back().connected);
        EXPECT_EQ(events.back().attempt, events.size() - 1);
        for (const client::ReconnectEvent& event : events) {
            EXPECT_FALSE(event.reason.empty());
            EXPECT_GT(event.left, 0ms);
            EXPECT_LT(event.left, 60s);
        }
        events.clear();
    }

    std::mutex mutex;
    std::vector<client::ReconnectEvent> events;
};

TEST(ReconnectEvents, TellOfEveryBreakOfAStream) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    Listener listener;
    auto stream = far.stream(running.session(), {.reconnect = 60s, .on_reconnect = listener.handler()});
    for (std::uint64_t i = 0; i < 3; ++i) {
        stream.push(wave(4, 0.0).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        if (i > 0) listener.expect_attempts_and_success();
        proxy.cut();
    }
}

TEST(ReconnectEvents, TheLongestWaitIsNoneThatIsOverAtOnce) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    const std::string id = running.session();
    auto stream = far.stream(id, {.reconnect = std::chrono::milliseconds::max()});
    auto watcher = far.watch(id, {.reconnect = std::chrono::milliseconds::max()});
    for (std::uint64_t i = 0; i < 2; ++i) {
        stream.push(wave(4, 0.0).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        ASSERT_TRUE(watcher.next());
        proxy.cut();
    }
}

TEST(LongestWaits, AreNotOverAtOnce) {
    ServerOptions options = on_tcp();
    options.http = "127.0.0.1:0";
    RunningServer running(options);
    constexpr auto longest = std::chrono::milliseconds::max();
    client::Client client(running.server.address(), {.timeout = longest, .wait = longest});
    const std::string id = running.session();
    auto stream = client.stream(id, {.reconnect = longest, .route_check = longest});
    auto watcher = client.watch(id, {.reconnect = longest, .route_check = longest});
    for (std::uint64_t i = 0; i < 5; ++i) {
        stream.push(wave(4, 0.0).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        ASSERT_TRUE(watcher.next());
    }
    EXPECT_EQ(sum_of(scrape(running.server.http_address()), "grpc_server_started_total{", "\"GetSession\""), 1.0)
        << "one look before the stream, and none after its route";
}

TEST(ReconnectEvents, TellOfEveryBreakOfAWatcher) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    for (const bool looks : {false, true}) {
        const std::string id = running.session();
        auto stream = running.client.stream(id);
        Listener listener;
        auto watcher = far.watch(id, {.reconnect = 60s, .on_reconnect = listener.handler()});
        auto places = far.watch_particles(id, {.reconnect = 60s, .on_reconnect = listener.handler()});
        proxy.cut();
        stream.push(wave(4, 0.0).view(), 0, 0.0);
        ASSERT_TRUE(looks ? watcher.next(60s).frame : watcher.next());
        listener.expect_attempts_and_success();
        ASSERT_TRUE(looks ? places.next(60s).frame : places.next());
        listener.expect_attempts_and_success();
    }
}

TEST(ReconnectEvents, AreNotToldOnceTheStreamHasGone) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    client::Client client(running->server.address());
    std::promise<void> told;
    std::promise<void> leaving;
    std::atomic<int> returned = 0;
    {
        const auto listen = [&](const client::ReconnectEvent& event) {
            if (event.attempt > 1) return;
            told.set_value();
            leaving.get_future().wait();
            std::this_thread::sleep_for(500ms);  // longer than threads are waited for that write in vain
            ++returned;
        };
        auto stream = client.stream(running->session(), {.reconnect = 60s, .on_reconnect = listen});
        running.reset();
        told.get_future().wait();
        leaving.set_value();
    }
    EXPECT_EQ(returned, 1);
}

TEST(ReconnectEvents, MayBeAnsweredWithCancel) {
    auto running = std::make_unique<RunningServer>(on_tcp());
    client::Client client(running->server.address());
    client::Stream* canceled = nullptr;
    std::mutex mutex;
    auto stream = client.stream(running->session(), {.reconnect = 60s, .on_reconnect = [&](const auto&) {
                                                         const std::lock_guard lock(mutex);
                                                         canceled->cancel();
                                                     }});
    {
        const std::lock_guard lock(mutex);
        canceled = &stream;
    }
    running.reset();
    EXPECT_FALSE(stream.next());
}

}  // namespace
}  // namespace meniscus::server::test
