// Particles back to their watchers, over real sockets.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

void expect_near(const client::ReceivedParticles& received, const Particles& sent, std::size_t stride = 1) {
    ASSERT_EQ(received.frame_count, sent.positions.size() / 3);
    ASSERT_EQ(received.stride, stride);
    ASSERT_EQ(received.quantized.size(), 3 * ((sent.positions.size() / 3 + stride - 1) / stride));
    const Box& box = received.quantization_box;
    for (std::size_t i = 0; i < received.quantized.size(); ++i) {
        const std::size_t axis = i % 3;
        const double step = (box.max[axis] - box.min[axis]) / 65535.0;
        ASSERT_NEAR(box.min[axis] + received.quantized[i] * step, sent.positions[3 * stride * (i / 3) + axis],
                    0.5001 * step + 1e-12);
    }
}

void push_one(client::Client& client, const std::string& id, const ParticleFrame& frame, std::uint64_t index,
              const client::StreamOptions& options = {.receive_meshes = false}) {
    auto stream = client.stream(id, options);
    stream.push(frame, index, 0.25);
    stream.finish();
    while (stream.next()) {
    }
}

TEST(WatchParticles, ReceivesWhatWasSentWithinOneStepOfItsQuantization) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    auto stream = running.client.stream(id, {.receive_meshes = false});
    for (std::uint64_t i = 0; i < 3; ++i) {
        const Particles particles = wave(6, static_cast<double>(i));
        stream.push(particles.view(), i, 0.5);
        const auto received = watcher.next();
        ASSERT_TRUE(received);
        EXPECT_EQ(received->index, i);
        EXPECT_EQ(received->simulation_time, 0.5);
        EXPECT_EQ(received->particle_radius, radius);
        EXPECT_TRUE(received->levels.empty());
        expect_near(*received, particles);
    }
}

TEST(WatchParticles, ReceivesQuantizedPositionsAndLevelsAsTheyWereSent) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    Particles particles = quantized(wave(6, 0.0));
    for (std::size_t i = 0; i < particles.quantized.size() / 3; ++i)
        particles.levels.push_back(static_cast<std::uint8_t>(i % 4));
    push_one(running.client, id,
             {.positions = {},
              .quantized = particles.quantized,
              .quantization_box = particles.box,
              .levels = particles.levels},
             0);
    const auto received = watcher.next();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->quantized, particles.quantized);
    EXPECT_EQ(received->levels, particles.levels);
    EXPECT_EQ(received->quantization_box.min, particles.box.min);
    EXPECT_EQ(received->quantization_box.max, particles.box.max);
}

TEST(WatchParticles, ReceivesEveryKthOfMoreThanItTakes) {
    RunningServer running;
    const std::string id = running.session();
    const Particles particles = wave(6, 0.0);  // 216
    struct Case {
        std::uint64_t most;
        std::size_t stride;
    };
    push_one(running.client, id, particles.view(), 0);
    for (const auto& [most, stride] : {Case{0, 1}, {216, 1}, {215, 2}, {108, 2}, {107, 3}, {1, 216}, {1000, 1}}) {
        SCOPED_TRACE(most);
        const auto received = running.client.watch_particles(id, most).next();
        ASSERT_TRUE(received);
        expect_near(*received, particles, stride);
    }
}

TEST(WatchParticles, OfMoreThanOneMessageArriveWhole) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    const Particles particles = wave(57, 0.0);  // 1.1 MB of positions
    push_one(running.client, id, particles.view(), 0);
    const auto received = watcher.next();
    ASSERT_TRUE(received);
    expect_near(*received, particles);
}

TEST(WatchParticles, ReceivesAFrameWithoutAny) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    push_one(running.client, id, {}, 4);
    const auto received = watcher.next();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->index, 4U);
    EXPECT_TRUE(received->quantized.empty());
}

TEST(WatchParticles, OfAStoppedSessionAreThoseOfItsLastFrameUnderEveryPolicy) {
    for (const auto policy : {client::UploadPolicy::every_frame, client::UploadPolicy::latest}) {
        RunningServer running;
        const std::string id = running.session();
        for (std::uint64_t last = 0; last < 5; ++last) {
            SCOPED_TRACE(last);
            const Particles particles = wave(6, static_cast<double>(last));
            auto stream = running.client.stream(id, {.receive_meshes = false, .policy = policy});
            for (std::uint64_t i = 0; i < last; ++i) stream.push(wave(4, 0.0).view(), i, 0.0);
            stream.push(particles.view(), last, 0.0);
            stream.finish();
            while (stream.next()) {
            }
            for (int times = 0; times < 2; ++times) {
                const auto received = running.client.watch_particles(id).next();
                ASSERT_TRUE(received);
                EXPECT_EQ(received->index, last);
                expect_near(*received, particles);
            }
        }
    }
}

TEST(WatchParticles, AreNotThoseOfAFrameThatNeverCameToItsEnd) {
    RunningServer running;
    const std::string id = running.session();
    push_one(running.client, id, wave(6, 0.0).view(), 0);
    for (int i = 0; i < 2; ++i) {  // one for each of the session's two buffers
        RawStream broken(running.server.address(), id);
        broken.send_begin(1, 216);
        broken.send_chunk(100);
        broken.call->WritesDone();
        EXPECT_EQ(broken.finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    }
    auto watcher = running.client.watch_particles(id);
    const Particles particles = wave(5, 1.0);
    push_one(running.client, id, particles.view(), 7);
    const auto received = watcher.next();
    ASSERT_TRUE(received);
    EXPECT_EQ(received->index, 7U);
    expect_near(*received, particles);
}

TEST(WatchParticles, GivesWhoLagsWholeFramesAndTheNewestAtLast) {
    RunningServer running;
    Settings cropped = settings();
    cropped.domain = Box{.min = {0.0, 0.0, 0.0}, .max = {0.5, 0.5, 0.5}};  // meshes that are made in no time
    const std::string id = client::new_session_id();
    running.client.create_session(id, cropped);
    auto watcher = running.client.watch_particles(id);
    auto stream = running.client.stream(id, {.receive_meshes = false});
    // Far more than gRPC's buffers hold.
    constexpr std::uint64_t last = 60;
    Particles particles = wave(40, 0.0);
    for (std::uint64_t i = 0; i <= last; ++i) {
        particles.positions[0] = 0.001F * static_cast<float>(i);
        stream.push(particles.view(), i, 0.0);
    }
    stream.finish();
    while (stream.next()) {
    }
    std::uint64_t received = 0;
    for (;;) {
        const auto frame = watcher.next();  // throws if a frame is torn
        ASSERT_TRUE(frame);
        ++received;
        if (frame->index != last) continue;
        expect_near(*frame, particles);
        break;
    }
    EXPECT_LT(received, last);
    EXPECT_GT(running.client.session(id).frames_skipped, 0U);
}

TEST(WatchParticles, EndsWithItsSession) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    running.client.delete_session(id);
    EXPECT_FALSE(watcher.next());
}

TEST(WatchParticles, EndsWithTheServer) {
    RunningServer running;
    auto watcher = running.client.watch_particles(running.session());
    running.server.shutdown();
    EXPECT_THROW(watcher.next(), client::ServerError);
}

TEST(WatchParticles, EndsWhenItsCallerCancels) {
    RunningServer running;
    const std::string id = running.session();
    auto watcher = running.client.watch_particles(id);
    std::thread canceler([&] { watcher.cancel(); });
    EXPECT_FALSE(watcher.next());
    canceler.join();
    const auto guard = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (running.client.session(id).watchers != 0 && std::chrono::steady_clock::now() < guard)
        std::this_thread::yield();
    EXPECT_EQ(running.client.session(id).watchers, 0U);
}

TEST(WatchParticles, CountsAsAWatcher) {
    ServerOptions options = test_options();
    options.limits.watchers_per_session = 1;
    RunningServer running(options);
    const std::string id = running.session();
    auto first = running.client.watch_particles(id);
    EXPECT_EQ(running.client.session(id).watchers, 1U);
    EXPECT_THROW(running.client.watch_particles(id).next(), LimitExceeded);
    EXPECT_THROW(running.client.watch(id).next(), LimitExceeded);
}

TEST(WatchParticles, LeavesWatchersOfMeshesTheirMeshes) {
    RunningServer running;
    const std::string id = running.session();
    auto particles = running.client.watch_particles(id);
    auto meshes = running.client.watch(id);
    const Particles sent = wave(6, 0.0);
    push_one(running.client, id, sent.view(), 0);
    EXPECT_EQ(mesh_sha256(meshes.next()->mesh()), local_sha256(sent));
    expect_near(*particles.next(), sent);
}

}  // namespace
}  // namespace meniscus::server::test
