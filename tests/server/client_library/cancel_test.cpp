// Streams and watchers that their caller cancels, from any thread, at any moment.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "running_server.hpp"
#include "tcp_proxy.hpp"
#include "tcp_server.hpp"

namespace meniscus::server::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

client::ErrorCode code_of_push(client::Stream& stream, std::uint64_t index) {
    try {
        stream.push(wave(3, 0.0).view(), index, 0.0);
    } catch (const std::exception& error) {
        return client::code_of(error);
    }
    return client::ErrorCode::unknown;
}

/// For many sessions, one after the other, that may take their time to end.
ServerOptions without_limit() {
    ServerOptions options = test_options();
    options.limits.sessions = 0;
    return options;
}

/// How long a watcher of a resting session takes to be stopped, in the best of five attempts: the machine may be busy.
template <class Stop>
Clock::duration time_to_stop(RunningServer& running, Stop stop) {
    const std::string id = running.session();
    Clock::duration best = Clock::duration::max();
    for (int attempt = 0; attempt < 5; ++attempt) {
        std::stop_source stopping;
        auto watcher = running.client.watch(id, {.stop = stopping.get_token()});
        std::promise<void> waiting;
        auto ended = std::async(std::launch::async, [&] {
            waiting.set_value();
            return !watcher.next();
        });
        waiting.get_future().wait();
        const auto start = Clock::now();
        stop(watcher, stopping);
        EXPECT_TRUE(ended.get());
        best = std::min(best, Clock::now() - start);
    }
    return best;
}

TEST(Cancel, StopsAWatcherOfARestingSessionWithinATenthOfASecond) {
    RunningServer running;
    EXPECT_LT(time_to_stop(running, [](client::Watcher& watcher, std::stop_source&) { watcher.cancel(); }), 100ms);
    EXPECT_LT(time_to_stop(running, [](client::Watcher&, std::stop_source& stopping) { stopping.request_stop(); }),
              100ms);
}

TEST(Cancel, EndsAPushAndANextThatWait) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    for (const bool reconnecting : {false, true}) {
        auto stream = far.stream(running.session(),
                                 {.waiting_limit = 1, .reconnect = reconnecting ? 60'000ms : 0ms, .route_check = 10ms});
        stream.push(wave(3, 0.0).view(), 0, 0.0);
        ASSERT_TRUE(stream.next());
        if (reconnecting) proxy.swallow();
        if (reconnecting) stream.push(wave(3, 0.0).view(), 1, 0.0);
        auto next = std::async(std::launch::async, [&] { return stream.next().has_value(); });
        auto push = std::async(std::launch::async, [&] {
            std::uint64_t index = 2;
            client::ErrorCode code = client::ErrorCode::unknown;
            while (code == client::ErrorCode::unknown) code = code_of_push(stream, index++);
            return code;
        });
        stream.cancel();
        EXPECT_EQ(push.get(), client::ErrorCode::canceled);
        next.get();
        EXPECT_FALSE(stream.next());
        EXPECT_TRUE(stream.try_next().ended);
        EXPECT_EQ(code_of_push(stream, 1'000'000), client::ErrorCode::canceled);
    }
}

TEST(Cancel, IsHeededWhereItWasAskedForBefore) {
    RunningServer running;
    const std::string id = running.session();
    std::stop_source stopping;
    stopping.request_stop();
    auto stream = running.client.stream(id, {.stop = stopping.get_token()});
    EXPECT_FALSE(stream.next());
    EXPECT_EQ(code_of_push(stream, 0), client::ErrorCode::canceled);
    EXPECT_FALSE(running.client.watch(id, {.stop = stopping.get_token()}).next());
    EXPECT_TRUE(running.client.watch_particles(id, {.stop = stopping.get_token()}).try_next().ended);
}

TEST(Cancel, OfAWatcherEndsItThoughAFrameHasCome) {
    RunningServer running;
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    auto watcher = running.client.watch(id);
    for (std::uint64_t i = 0; i < 2; ++i) {
        stream.push(wave(4, static_cast<double>(i)).view(), i, 0.0);
        ASSERT_TRUE(stream.next());
        if (i == 0) {
            ASSERT_TRUE(watcher.next(60s));
        }
    }
    watcher.cancel();
    EXPECT_TRUE(watcher.try_next().ended);
    EXPECT_FALSE(watcher.next());
}

TEST(Cancel, MayComeAtAnyMomentOfAStream) {
    RunningServer running(without_limit());
    const Particles particles = wave(3, 0.0);
    for (int round = 0; round < 120; ++round) {
        std::stop_source stopping;
        const client::Session session = running.client.open_session(settings());
        std::optional<client::Stream> stream = running.client.stream(
            session.id(), {.waiting_limit = 2, .reconnect = round % 2 == 0 ? 60s : 0s, .stop = stopping.get_token()});
        std::thread pusher([&] {
            try {
                for (std::uint64_t i = 0;; ++i)
                    if (i % 2 == 0 || !stream->try_push(particles.view(), i, 0.0))
                        stream->push(particles.view(), i, 0.0);
            } catch (const client::ServerError& error) {
                EXPECT_EQ(error.code(), client::ErrorCode::canceled) << error.what();
            }
        });
        std::thread reader([&] {
            while (!stream->next(round % 8 == 0 ? 0ms : 1ms).ended) std::this_thread::yield();
        });
        for (int i = 0; i < round % 16; ++i) std::this_thread::yield();
        if (round % 4 < 2) stream->cancel();
        stopping.request_stop();
        pusher.join();
        reader.join();
    }
}

TEST(Cancel, MayComeWhileAStreamOrAWatcherGoes) {
    RunningServer running(without_limit());
    const std::string id = running.session();
    const Particles particles = wave(3, 0.0);
    for (int round = 0; round < 120; ++round) {
        std::stop_source stopping;
        const client::Session session = running.client.open_session(settings());
        std::optional<client::Stream> stream = running.client.stream(session.id(), {.stop = stopping.get_token()});
        std::optional<client::Watcher> watcher = running.client.watch(id, {.stop = stopping.get_token()});
        std::optional<client::ParticleWatcher> places =
            running.client.watch_particles(id, {.stop = stopping.get_token()});
        stream->push(particles.view(), 0, 0.0);
        if (round % 2 == 0) {
            EXPECT_FALSE(watcher->try_next());
        }
        if (round % 3 == 0) {
            EXPECT_FALSE(places->try_next());
        }
        std::thread stopper([&] { stopping.request_stop(); });
        if (round % 4 == 0) std::this_thread::yield();
        stream.reset();
        watcher.reset();
        places.reset();
        stopper.join();
    }
}

TEST(TryPush, TakesNothingWherePushWouldWait) {
    RunningServer running(on_tcp());
    TcpProxy proxy(port_of(running.server.address()));
    client::Client far(proxy.address());
    auto stream = far.stream(running.session(), {.waiting_limit = 1});
    const Particles particles = wave(4, 0.0);
    ASSERT_TRUE(stream.try_push(particles.view(), 0, 0.0));
    EXPECT_FALSE(stream.try_push(particles.view(), 1, 0.0));
    client::ParticleBuffer buffer(std::vector<float>(particles.positions));
    EXPECT_FALSE(stream.try_push(std::move(buffer), 1, 0.0));
    ASSERT_FALSE(buffer.is_taken());  // NOLINT(bugprone-use-after-move): it was not taken
    EXPECT_FALSE(stream.try_push(StridedPositions(particles.positions), 1, 0.0));
    ASSERT_TRUE(stream.next());
    // The index is free, and the buffer as it was.
    EXPECT_TRUE(stream.try_push(std::move(buffer), 1, 0.0));
    EXPECT_TRUE(buffer.is_taken());  // NOLINT(bugprone-use-after-move): what was moved from says so
    EXPECT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(particles));
    stream.finish();
    EXPECT_THROW(stream.try_push(particles.view(), 2, 0.0), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
