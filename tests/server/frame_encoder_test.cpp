#include "sessions/frame_encoder.hpp"

#include <gtest/gtest.h>

#include "meniscus/brick_coding.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

ReconstructedFrame reconstructed(const test::Particles& particles) {
    ReconstructedFrame frame;
    frame.index = 5;
    frame.simulation_time = 2.5;
    frame.received_at = std::chrono::steady_clock::now();
    Reconstructor reconstructor(test::settings(), {.threads = 1});
    reconstructor.reconstruct(particles.view(), frame.mesh);
    frame.statistics = reconstructor.statistics();
    return frame;
}

v1::WatchResponse parsed(const SharedMessage& message) {
    v1::WatchResponse response;
    EXPECT_TRUE(response.ParseFromString(*message));
    return response;
}

TEST(FrameEncoder, SendsBeginThenBricksThenStatistics) {
    WorkerPool workers(3);
    const ReconstructedFrame frame = reconstructed(test::wave(12, 0.0));
    std::vector<SharedMessage> sent;
    const auto encoded = encode_frame(frame, 8, workers, [&](const SharedMessage& m) { sent.push_back(m); });
    EXPECT_EQ(encoded->messages, sent);
    ASSERT_EQ(sent.size(), frame.mesh.bricks.size() + 2);
    EXPECT_EQ(parsed(sent.front()).mesh_begin().frame_index(), 5U);
    EXPECT_EQ(parsed(sent.front()).mesh_begin().brick_count(), frame.mesh.bricks.size());
    std::uint64_t bytes = 0;
    for (std::size_t i = 1; i + 1 < sent.size(); ++i) {
        EXPECT_TRUE(parsed(sent[i]).has_mesh_brick());
        bytes += sent[i]->size();
    }
    const v1::WatchResponse end = parsed(sent.back());
    EXPECT_EQ(end.frame_statistics().frame_index(), 5U);
    EXPECT_EQ(end.frame_statistics().simulation_time(), 2.5);
    EXPECT_EQ(end.frame_statistics().triangles(), frame.mesh.triangles.size());
    EXPECT_EQ(end.frame_statistics().encoded_bytes(), bytes);
}

TEST(FrameEncoder, KeepsThePartsOfABrickTogetherAndWithinTheChunkSize) {
    // Random levels and places make a brick that compresses badly.
    test::Particles particles;
    std::uint32_t state = 1;
    for (int i = 0; i < 3 * 40000; ++i) {
        state = state * 1664525U + 1013904223U;
        particles.positions.push_back(static_cast<float>(state >> 8U) / static_cast<float>(1U << 24U) * 6.3F);
    }
    ReconstructedFrame frame = reconstructed(particles);
    WorkerPool workers(2);
    const auto encoded = encode_frame(frame, 16, workers, nullptr);
    std::uint32_t expected_part = 0;
    for (const SharedMessage& message : encoded->messages) {
        const v1::WatchResponse response = parsed(message);
        if (!response.has_mesh_brick()) continue;
        EXPECT_LE(response.mesh_brick().draco().size(), chunk_bytes);
        EXPECT_EQ(response.mesh_brick().part_index(), expected_part);
        expected_part = (expected_part + 1) % response.mesh_brick().part_count();
    }
    EXPECT_EQ(expected_part, 0U);
}

TEST(FrameEncoder, SendsAnEmptyMesh) {
    WorkerPool workers(1);
    const auto encoded = encode_frame(reconstructed({}), 8, workers, nullptr);
    ASSERT_EQ(encoded->messages.size(), 2U);
    EXPECT_EQ(parsed(encoded->messages[0]).mesh_begin().brick_count(), 0U);
    EXPECT_GT(parsed(encoded->messages[0]).mesh_begin().cell_size(), 0.0);
}

}  // namespace
}  // namespace meniscus::server
