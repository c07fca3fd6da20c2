// Particles without company, from a simulator's frame to receivers that ask for points beside the surface.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "running_server.hpp"
#include "sample_files.hpp"

namespace meniscus::server::test {
namespace {

Settings with_spray(Spray spray) {
    Settings chosen = settings();
    chosen.field = Field::smooth;
    chosen.spray = spray;
    return chosen;
}

std::string session(client::Client& client, Spray spray) {
    std::string id = client::new_session_id();
    client.create_session(id, with_spray(spray));
    return id;
}

/// The answer to a frame, for a stream that asks for spray.
client::ReceivedFrame answer(client::Client& client, const std::string& id, const Particles& particles,
                             bool asks = true) {
    client::StreamOptions options;
    options.spray = asks;
    auto stream = client.stream(id, options);
    stream.push(particles.view(), 0, 0.0);
    stream.finish();
    auto frame = stream.next();
    EXPECT_TRUE(frame);
    EXPECT_FALSE(stream.next());
    return frame ? *frame : client::ReceivedFrame();
}

const Particles lone{.positions = {1.0F, 2.0F, -3.0F}, .quantized = {}, .box = {}, .levels = {}};

void expect_at_the_lone_ones_place(const std::vector<Point>& spray) {
    ASSERT_EQ(spray.size(), 1U);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(spray[0][axis], lone.positions[axis], 1e-4);
}

TEST(SprayOverTheWire, ALoneParticleIsAPointAndNoTriangle) {
    RunningServer running;
    const client::ReceivedFrame frame = answer(running.client, session(running.client, Spray::points), lone);
    EXPECT_TRUE(frame.bricks.empty());
    expect_at_the_lone_ones_place(frame.spray);
}

TEST(SprayOverTheWire, ALoneParticleIsADropWhereItIsKeptAndNothingWhereItIsDiscarded) {
    RunningServer running;
    const client::ReceivedFrame kept = answer(running.client, session(running.client, Spray::keep), lone);
    EXPECT_GT(kept.mesh().triangles.size(), 0U);
    EXPECT_TRUE(kept.spray.empty());
    const client::ReceivedFrame gone = answer(running.client, session(running.client, Spray::discard), lone);
    EXPECT_TRUE(gone.bricks.empty());
    EXPECT_TRUE(gone.spray.empty());
}

TEST(SprayOverTheWire, IsLeftOutForThoseWhoDoNotAsk) {
    RunningServer running;
    EXPECT_TRUE(answer(running.client, session(running.client, Spray::points), lone, false).spray.empty());
}

TEST(SprayOverTheWire, AStreamAWatcherAtAnyLevelAndThisProcessHaveTheSamePoints) {
    const Particles particles = spray(6);
    Reconstructor here(with_spray(Spray::points), {.threads = 1});
    Mesh expected;
    here.reconstruct(particles.view(), expected);
    ASSERT_EQ(expected.spray.size(), particles.view().count());
    const std::vector<Point> points(expected.spray.begin(), expected.spray.end());

    RunningServer running;
    const std::string id = session(running.client, Spray::points);
    EXPECT_EQ(answer(running.client, id, particles).spray, points);
    for (const int max_level : {3, 2, 1}) {
        auto watcher = running.client.watch(id, {.max_level = max_level, .spray = true});
        const auto frame = watcher.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->spray, points) << max_level;
    }
    auto asks_not = running.client.watch(id);
    EXPECT_TRUE(asks_not.next()->spray.empty());
}

TEST(SprayOverTheWire, IsRecordedAndReadAgain) {
    const meniscus::test::TemporaryDirectory folder;
    ServerOptions options = test_options();
    options.recording.directory = folder.path();
    RunningServer running(options);
    const std::string id = session(running.client, Spray::points);
    answer(running.client, id, lone);
    running.client.delete_session(id);
    // A hang guard bounds it.
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (running.client.recordings().empty() || running.client.recordings().at(0).frames == 0) {
        ASSERT_LT(std::chrono::steady_clock::now(), guard);
        std::this_thread::yield();
    }
    const auto read = [&](bool asks) { return running.client.read_recording(id, 1, {.spray = asks}).next(); };
    const auto asked = read(true);
    ASSERT_TRUE(asked);
    expect_at_the_lone_ones_place(asked->spray);
    const auto not_asked = read(false);
    ASSERT_TRUE(not_asked);
    EXPECT_TRUE(not_asked->spray.empty());
}

}  // namespace
}  // namespace meniscus::server::test
