// Frames in, meshes out, through the client library.
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

constexpr std::uint64_t frame_count = 6;

TEST(Stream, ReturnsTheMeshesOfALocalReconstruction) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    for (std::uint64_t i = 0; i < frame_count; ++i)
        stream.push(wave(8, static_cast<double>(i)).view(), i, 0.5 * static_cast<double>(i));
    stream.finish();
    for (std::uint64_t i = 0; i < frame_count; ++i) {
        const auto frame = stream.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->index, i);
        EXPECT_EQ(frame->simulation_time, 0.5 * static_cast<double>(i));
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(wave(8, static_cast<double>(i))));
    }
    EXPECT_FALSE(stream.next());
}

TEST(Stream, ReturnsTheMeshesOfQuantizedPositions) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    const Particles particles = quantized(wave(8, 1.0));
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(particles));
}

TEST(Stream, ReturnsTheMeshesOfParticleLevels) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    Particles particles = wave(8, 1.0);
    for (std::size_t i = 0; i < particles.positions.size() / 3; ++i)
        particles.levels.push_back(static_cast<std::uint8_t>(i % 64 == 0 ? 1 : 0));
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(particles));
}

TEST(Stream, CutsFramesThatAreLargerThanAChunk) {
    RunningServer running;
    auto stream = running.client.stream(running.session(), {.receive_meshes = false});
    const Particles particles = wave(48, 0.0);  // 1.3 MB
    stream.push(particles.view(), 0, 0.0);
    EXPECT_EQ(stream.next()->statistics.particles, particles.positions.size() / 3);
}

TEST(Stream, AnswersAnEmptyFrameWithAnEmptyMesh) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    stream.push({}, 0, 0.0);
    const auto frame = stream.next();
    EXPECT_TRUE(frame->bricks.empty());
    EXPECT_TRUE(frame->mesh().triangles.empty());
    EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256({}));
}

TEST(Stream, BringsTheServersFigures) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    const Particles particles = wave(8, 0.0);
    stream.push(particles.view(), 0, 0.0);
    const auto frame = stream.next();
    Reconstructor reconstructor(settings(), {.threads = 1});
    Mesh mesh;
    reconstructor.reconstruct(particles.view(), mesh);
    const client::FrameStatistics& remote = frame->statistics;
    const Statistics& local = reconstructor.statistics();
    EXPECT_EQ(remote.particles, local.particles);
    EXPECT_EQ(remote.vertices, local.vertices);
    EXPECT_EQ(remote.triangles, local.triangles);
    EXPECT_EQ(remote.triangles_by_level, local.triangles_by_level);
    EXPECT_EQ(remote.base_cells_by_level, local.base_cells_by_level);
    EXPECT_EQ(remote.field_evaluations, local.field_evaluations);
    EXPECT_EQ(remote.backend, local.backend);
    EXPECT_GT(remote.encode_seconds, 0.0);
    EXPECT_GE(remote.latency_seconds, remote.encode_seconds);
    EXPECT_GE(remote.encoded_bytes,
              std::accumulate(frame->bricks.begin(), frame->bricks.end(), std::size_t{0},
                              [](std::size_t sum, const auto& b) { return sum + b->data.size(); }));
}

TEST(Stream, SendsNoMeshesToWhoWantsNone) {
    RunningServer running;
    auto stream = running.client.stream(running.session(), {.receive_meshes = false});
    stream.push(wave(6, 0.0).view(), 4, 0.25);
    const auto frame = stream.next();
    EXPECT_EQ(frame->index, 4U);
    EXPECT_EQ(frame->simulation_time, 0.25);
    EXPECT_TRUE(frame->bricks.empty());
    EXPECT_GT(frame->statistics.triangles, 0U);
    EXPECT_EQ(frame->statistics.encoded_bytes, 0U);
}

TEST(Stream, HasNormalsAsAskedFor) {
    RunningServer running;
    auto without = running.client.stream(running.session(), {.normal_bits = 0});
    without.push(wave(6, 0.0).view(), 0, 0.0);
    const auto plain = without.next();
    EXPECT_TRUE(decode_brick(*plain->bricks.at(0), plain->offset_bits).normals.empty());
    auto with = running.client.stream(running.session(), {.normal_bits = 10});
    with.push(wave(6, 0.0).view(), 0, 0.0);
    const auto shaded = with.next();
    EXPECT_FALSE(decode_brick(*shaded->bricks.at(0), shaded->offset_bits).normals.empty());
}

TEST(Stream, NeverBlocksACallerThatOnlyPushes) {
    RunningServer running;
    auto stream = running.client.stream(running.session());
    constexpr std::uint64_t many = 60;
    const Particles particles = wave(8, 0.0);
    for (std::uint64_t i = 0; i < many; ++i) stream.push(particles.view(), i, 0.0);
    stream.finish();
    std::uint64_t received = 0;
    while (stream.next()) ++received;
    EXPECT_EQ(received, many);
}

TEST(Stream, WaitsWithAPushBeyondItsWaitingLimit) {
    RunningServer running;
    auto stream = running.client.stream(running.session(), {.waiting_limit = 2});
    const Particles particles = wave(6, 0.0);
    stream.push(particles.view(), 0, 0.0);
    stream.push(particles.view(), 1, 0.0);
    std::atomic<bool> pushed{false};
    std::thread pusher([&] {
        stream.push(particles.view(), 2, 0.0);
        pushed = true;
        stream.finish();
    });
    EXPECT_FALSE(pushed);  // whenever it is looked at before next()
    std::uint64_t received = 0;
    while (stream.next()) ++received;
    EXPECT_EQ(received, 3U);
    pusher.join();
}

TEST(Stream, IsOneAtATimePerSession) {
    RunningServer running;
    const std::string id = running.session();
    auto first = running.client.stream(id);
    first.push(wave(4, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(first.next());
    auto second = running.client.stream(id);
    EXPECT_THROW(second.next(), client::ServerError);
    first.finish();
    EXPECT_FALSE(first.next());
    auto third = running.client.stream(id);
    third.push(wave(4, 0.0).view(), 0, 0.0);
    EXPECT_TRUE(third.next());
}

TEST(Stream, CanBeLeftWithFramesInFlight) {
    RunningServer running;
    const std::string id = running.session();
    {
        auto stream = running.client.stream(id);
        for (std::uint64_t i = 0; i < 5; ++i) stream.push(wave(8, 0.0).view(), i, 0.0);
    }
    EXPECT_EQ(running.client.session(id).id, id);
}

TEST(Stream, OfASimulatorThatVanishesLeavesNoSessionForLong) {
    ServerOptions options = test_options();
    options.limits.orphan_time = std::chrono::milliseconds(20);
    options.limits.sessions = 64;
    RunningServer running(options);
    for (const bool in_mid_frame : {false, true})
        for (int time = 0; time < 20; ++time) {
            RawStream stream(running.server.address(), running.session());
            stream.call->WaitForInitialMetadata();
            stream.send_begin(0, 10);
            stream.send_chunk(12);
            if (!in_mid_frame) {
                stream.send_chunk(108);
                stream.send_end();
            }
            // At a different moment each time: before, while and after the frame is there.
            std::this_thread::sleep_for(std::chrono::microseconds(100 * time));
            stream.context.TryCancel();
            stream.finish();
        }
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    std::size_t left = 40;
    while (left != 0 && std::chrono::steady_clock::now() < give_up) left = running.client.sessions().size();
    EXPECT_EQ(left, 0U);
}

TEST(Stream, EndsWithItsSession) {
    RunningServer running;
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    stream.push(wave(6, 0.0).view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    running.client.delete_session(id);
    EXPECT_THROW(stream.next(), client::ServerError);
}

TEST(Stream, SessionsStreamSideBySide) {
    RunningServer running;
    std::vector<std::thread> simulators;
    simulators.reserve(3);
    for (int s = 0; s < 3; ++s)
        simulators.emplace_back([&running, s] {
            client::Client own(running.server.address());
            const std::string id = client::new_session_id();
            own.create_session(id, settings());
            auto stream = own.stream(id);
            for (std::uint64_t i = 0; i < 4; ++i) {
                const Particles particles = wave(6, s + static_cast<double>(i));
                stream.push(particles.view(), i, 0.0);
                EXPECT_EQ(mesh_sha256(stream.next()->mesh()), local_sha256(particles));
            }
        });
    for (std::thread& simulator : simulators) simulator.join();
}

}  // namespace
}  // namespace meniscus::server::test
