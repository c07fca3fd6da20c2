#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <random>
#include <thread>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

TEST(Watch, ReceivesTheMeshesOfAStream) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    auto stream = running.client.stream(id, {.receive_meshes = false});
    for (std::uint64_t i = 0; i < 4; ++i) {
        const Particles particles = wave(6, static_cast<double>(i));
        stream.push(particles.view(), i, 0.5);
        const auto frame = watcher.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->index, i);
        EXPECT_EQ(frame->simulation_time, 0.5);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    }
}

TEST(Watch, StartsWithTheCurrentMesh) {
    RunningServer running;
    const std::string id = running.session();
    const Particles particles = wave(6, 0.0);
    auto stream = running.client.stream(id);
    stream.push(particles.view(), 5, 0.0);
    ASSERT_TRUE(stream.next());
    for (const int normal_bits : {8, 0, 12}) {
        auto watcher = running.client.watch(id, {.normal_bits = normal_bits});
        const auto frame = watcher.next();
        EXPECT_EQ(frame->index, 5U);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    }
}

TEST(Watch, ServesSeveralWatchers) {
    RunningServer running;
    const std::string id = running.session();
    auto first = running.client.watch(id);
    auto second = running.client.watch(id, {.normal_bits = 0});
    EXPECT_EQ(running.client.session(id).watchers, 2U);
    const Particles particles = wave(6, 0.0);
    auto stream = running.client.stream(id);
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(mesh_sha256(first.next()->mesh()), local_sha256(particles));
    EXPECT_EQ(mesh_sha256(second.next()->mesh()), local_sha256(particles));
}

TEST(Watch, GivesWhoLagsWholeFramesAndTheNewestAtLast) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    auto stream = running.client.stream(id, {.receive_meshes = false});
    // Far more than gRPC's buffers hold.
    constexpr std::uint64_t last = 80;
    const Particles particles = spray(12);
    Particles moved = particles;
    for (float& p : moved.positions) p += 0.03F;
    for (std::uint64_t i = 0; i <= last; ++i) stream.push((i % 2 == 0 ? particles : moved).view(), i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
    std::uint64_t received = 0;
    for (;;) {
        const auto frame = watcher.next();  // throws if a frame is torn
        ASSERT_TRUE(frame);
        ++received;
        if (frame->index != last) continue;
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
        break;
    }
    EXPECT_LT(received, last);
}

/// Two bodies of water, of which one moves.
Particles half_still(double phase) {
    Particles particles = wave(8, phase);
    for (const float p : wave(8, 0.0).positions) particles.positions.push_back(p + 20.0F);
    return particles;
}

/// The watcher waits a little after each frame, so that it may miss some.
void watch_what_changes(RunningServer& running, Codec codec) {
    SCOPED_TRACE(name_of(codec));
    const std::string id = running.session();
    auto watcher = running.client.watch(id, {.codec = codec});
    auto stream = running.client.stream(id, {.receive_meshes = false});
    constexpr std::uint64_t last = 40;
    std::thread simulator([&] {
        for (std::uint64_t i = 0; i <= last; ++i) stream.push(half_still(0.2 * static_cast<double>(i)).view(), i, 0.0);
        stream.finish();
        while (stream.next()) {
        }
    });
    std::mt19937 random(1);
    std::size_t unchanged = 0;
    std::size_t bricks = 0;
    for (bool first = true;; first = false) {
        const auto frame = watcher.next();
        ASSERT_TRUE(frame);
        for (const auto& brick : frame->bricks) EXPECT_EQ(brick->codec, codec);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(half_still(0.2 * static_cast<double>(frame->index))));
        if (!first) {
            for (const auto& place : frame->changed) EXPECT_LT(place[0], 2);
            unchanged += frame->bricks.size() - frame->changed.size();
            bricks += frame->bricks.size();
        }
        if (frame->index == last) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 20));
    }
    EXPECT_GT(unchanged, 0U);
    std::printf("%zu of %zu bricks were not sent again\n", unchanged, bricks);
    simulator.join();
}

TEST(Watch, ReceivesOnlyWhatChangedAndHasTheWholeMeshOfEveryFrame) {
    RunningServer running;
    for (const Codec codec : codecs) watch_what_changes(running, codec);
}

TEST(Watch, EndsWithItsSessionAndSaysWhy) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch(id);
    running.client.delete_session(id);
    EXPECT_EQ(watcher.end_reason(), "");
    EXPECT_FALSE(watcher.next());
    EXPECT_EQ(watcher.end_reason(), "it was deleted");
}

TEST(Watch, EndsWhenItsCallerCancels) {
    RunningServer running;
    auto watcher = running.client.watch(running.session());
    std::thread canceler([&] { watcher.cancel(); });
    EXPECT_FALSE(watcher.next());
    canceler.join();
}

TEST(Watch, IsRefusedWithoutASession) {
    RunningServer running;
    auto watcher = running.client.watch(client::new_session_id());
    EXPECT_THROW(watcher.next(), client::ServerError);
}

TEST(Watch, IsRefusedPastTheLimit) {
    ServerOptions options = test_options();
    options.limits.watchers_per_session = 1;
    RunningServer running(options);
    const std::string id = running.session();
    auto first = running.client.watch(id);
    auto second = running.client.watch(id);
    EXPECT_THROW(second.next(), LimitExceeded);
}

}  // namespace
}  // namespace meniscus::server::test
