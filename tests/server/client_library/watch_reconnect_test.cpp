// Watchers that outlive their server.
#include <gtest/gtest.h>

#include <future>
#include <optional>

#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

TEST(WatchReconnect, GoesOnWhenTheServerAndThenTheSessionAreBack) {
    const ServerOptions options = test_options();
    std::optional<RunningServer> running(std::in_place, options);
    const std::string id = running->session();
    auto watcher = client::Client(options.listen).watch(id, {.reconnect = std::chrono::seconds(60)});
    const Particles particles = wave(6, 0.0);
    {
        auto stream = running->client.stream(id);
        stream.push(particles.view(), 4, 0.0);
        ASSERT_TRUE(stream.next());
    }
    const auto before = watcher.next();
    EXPECT_EQ(before->index, 4U);
    auto after = std::async(std::launch::async, [&] { return watcher.next(); });
    running.reset();
    running.emplace(options);
    running->client.create_session(id, settings());
    auto stream = running->client.stream(id);
    // A run without a name has nothing to do with the one before: its frames are new, whatever their index.
    stream.push(particles.view(), 2, 0.0);
    const auto frame = after.get();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, 2U);
    EXPECT_EQ(frame->changed.size(), frame->bricks.size());
    EXPECT_TRUE(frame->vanished.empty());
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
}

TEST(WatchReconnect, GoesOnWithTheParticlesToo) {
    const ServerOptions options = test_options();
    std::optional<RunningServer> running(std::in_place, options);
    const std::string id = running->session();
    auto watcher = client::Client(options.listen).watch_particles(id, 0, std::chrono::seconds(60));
    const Particles particles = wave(6, 0.0);
    {
        auto stream = running->client.stream(id);
        stream.push(particles.view(), 4, 0.0);
        ASSERT_TRUE(stream.next());
    }
    EXPECT_EQ(watcher.next()->index, 4U);
    auto after = std::async(std::launch::async, [&] { return watcher.next(); });
    running.reset();
    running.emplace(options);
    running->client.create_session(id, settings());
    auto stream = running->client.stream(id);
    stream.push(particles.view(), 5, 0.0);
    EXPECT_EQ(after.get()->index, 5U);
}

TEST(WatchReconnect, GivesUpAfterTheTimeThatItWasGiven) {
    std::optional<RunningServer> running(std::in_place);
    auto watcher = running->client.watch(running->session(), {.reconnect = std::chrono::milliseconds(300)});
    running->server.shutdown();
    EXPECT_THROW(watcher.next(), client::ServerError);
    EXPECT_FALSE(watcher.next());
}

TEST(WatchReconnect, EndsWhenItsCallerCancelsWhileThereIsNoServer) {
    RunningServer running;
    auto watcher = running.client.watch(running.session(), {.reconnect = std::chrono::hours(1)});
    running.server.shutdown();
    auto next = std::async(std::launch::async, [&] { return watcher.next(); });
    watcher.cancel();
    EXPECT_FALSE(next.get());
}

TEST(WatchReconnect, DoesNotWaitForASessionThatItNeverHad) {
    RunningServer running;
    auto watcher = running.client.watch(client::new_session_id(), {.reconnect = std::chrono::hours(1)});
    EXPECT_THROW(watcher.next(), client::ServerError);
}

}  // namespace
}  // namespace meniscus::server::test
