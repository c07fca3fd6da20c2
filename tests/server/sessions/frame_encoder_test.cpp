#include "sessions/sending/frame_encoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "late_meshes.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "packing_mesh.hpp"
#include "sessions/limits/limits.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

struct FrameOf : ReconstructedFrame {
    explicit FrameOf(const test::Particles& particles) {
        index = 5;
        simulation_time = 2.5;
        received_at = std::chrono::steady_clock::now();
        Reconstructor reconstructor(test::settings(), {.threads = 1, .keep_lattice = true});
        reconstructor.reconstruct(particles.view(), mesh);
        statistics = reconstructor.statistics();
    }
};

v1::WatchResponse parsed(const SharedMessage& message) {
    v1::WatchResponse response;
    EXPECT_TRUE(response.ParseFromString(*message));
    return response;
}

TEST(FrameEncoder, SendsBeginThenBricksAndReturnsTheEndWithTheStatistics) {
    WorkerPool workers(3);
    ScratchPool scratch;
    const FrameOf frame(test::wave(12, 0.0));
    std::vector<SharedMessage> sent;
    const auto encoded = encode_frame(frame, {.normal_bits = 8}, nullptr, workers, scratch,
                                      [&](const SharedMessage& m) { sent.push_back(m); });
    EXPECT_EQ(encoded->begin, sent.front());
    ASSERT_EQ(sent.size(), frame.mesh.bricks.size() + 1);
    EXPECT_EQ(parsed(sent.front()).mesh_begin().frame_index(), 5U);
    EXPECT_EQ(parsed(sent.front()).mesh_begin().brick_count(), frame.mesh.bricks.size());
    EXPECT_EQ(parsed(sent.front()).mesh_begin().triangle_count(), frame.mesh.triangles.size());
    std::uint64_t bytes = 0;
    for (std::size_t i = 1; i < sent.size(); ++i) {
        EXPECT_TRUE(parsed(sent[i]).has_mesh_brick());
        bytes += sent[i]->size();
    }
    const v1::WatchResponse end = parsed(encoded->end);
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
    const FrameOf frame(particles);
    WorkerPool workers(2);
    ScratchPool scratch;
    const auto encoded = encode_frame(frame, {.normal_bits = 16}, nullptr, workers, scratch, nullptr);
    for (const SharedBrick& brick : encoded->bricks) {
        std::uint32_t part = 0;
        for (const SharedMessage& message : brick->messages) {
            const v1::WatchResponse response = parsed(message);
            EXPECT_LE(response.mesh_brick().data().size(), chunk_bytes);
            EXPECT_EQ(response.mesh_brick().part_index(), part++);
            EXPECT_EQ(response.mesh_brick().part_count(), brick->messages.size());
        }
    }
}

TEST(FrameEncoder, TellsTheDownloadsTimeOfTheMeshThatItSendsAlone) {
    FrameOf frame(test::wave(6, 0.0));
    frame.download = MeshDownload(std::make_shared<test::LateMesh>(std::make_shared<test::LateMeshes>(), frame.mesh));
    auto& capped = frame.capped_at(2);
    Reconstructor(test::settings(), {.threads = 1}).reconstruct(test::wave(3, 0.0).view(), capped.mesh);
    capped.made = true;
    WorkerPool workers(1);
    ScratchPool scratch;
    const auto seconds = [&](int max_level) {
        const auto encoded =
            encode_frame(frame, {.max_level = max_level, .normal_bits = 8}, nullptr, workers, scratch, nullptr);
        return parsed(encoded->end).frame_statistics().download_seconds();
    };
    EXPECT_EQ(seconds(3), 0.25);
    EXPECT_EQ(seconds(2), 0.0);
}

TEST(FrameEncoder, HasTheSprayAtEveryLevelCapAndSendsItWhereThatIsAskedFor) {
    FrameOf frame(test::wave(6, 0.0));
    frame.mesh.spray.push_back({1.0F, 2.0F, 3.0F});
    Reconstructor(test::settings(), {.threads = 1}).reconstruct(test::wave(3, 0.0).view(), frame.capped_at(2).mesh);
    frame.capped_at(2).made = true;
    WorkerPool workers(1);
    ScratchPool scratch;
    for (const int max_level : {3, 2})
        for (const bool asked_for : {false, true}) {
            std::vector<SharedMessage> sent;
            const auto encoded = encode_frame(
                frame, {.max_level = max_level, .normal_bits = 8}, nullptr, workers, scratch,
                [&](const SharedMessage& m) { sent.push_back(m); }, asked_for);
            EXPECT_EQ(parsed(encoded->begin).mesh_begin().spray_count(), 1U);
            ASSERT_EQ(encoded->spray.size(), 1U);
            EXPECT_EQ(std::ranges::count(sent, encoded->spray[0]), asked_for ? 1 : 0);
            EXPECT_EQ(std::ranges::count(sent, encoded->end), 0);
        }
}

TEST(FrameEncoder, FindsTheRangesOfAttributesOnceForAllFormatsOfALevelCap) {
    FrameOf frame(test::wave(6, 0.0));
    auto& capped = frame.capped_at(2);
    Reconstructor(test::settings(), {.threads = 1}).reconstruct(test::wave(3, 0.0).view(), capped.mesh);
    capped.made = true;
    const auto give_values_up_to = [](Mesh& mesh, float greatest) {
        std::vector<float> values(mesh.vertices.size());
        values.back() = greatest;
        mesh.attributes = {{"age", ElementType::float32, 1, {}}};
        const auto bytes = std::as_bytes(std::span(values));
        mesh.attributes[0].data.assign(bytes.begin(), bytes.end());
    };
    give_values_up_to(frame.mesh, 3.0F);
    give_values_up_to(capped.mesh, 2.0F);
    WorkerPool workers(1);
    ScratchPool scratch;
    const auto announced = [&](int max_level, int bits) {
        const MeshFormat format{.max_level = max_level, .attributes = {{.name = "age", .bits = bits}}};
        const auto encoded = encode_frame(frame, format, nullptr, workers, scratch, nullptr);
        return parsed(encoded->begin).mesh_begin().attributes(0).maximum(0);
    };
    EXPECT_EQ(announced(3, 8), 3.0);
    EXPECT_EQ(announced(2, 8), 2.0);
    // No format looks at the values of all vertices again.
    const auto* const found = frame.ranges_at(3).data();
    give_values_up_to(frame.mesh, 2.5F);
    EXPECT_EQ(announced(3, 12), 3.0);
    EXPECT_EQ(frame.ranges_at(3).data(), found);
    frame.release_memory();
    EXPECT_TRUE(frame.ranges_at(3).empty());
}

TEST(FrameEncoder, SendsAnEmptyMesh) {
    WorkerPool workers(1);
    ScratchPool scratch;
    const auto encoded = encode_frame(FrameOf({}), {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
    EXPECT_TRUE(encoded->bricks.empty());
    EXPECT_EQ(parsed(encoded->begin).mesh_begin().brick_count(), 0U);
    EXPECT_GT(parsed(encoded->begin).mesh_begin().cell_size(), 0.0);
}

/// Two bodies of water, far apart; one of them moves.
test::Particles two_bodies(double phase) {
    test::Particles both = test::wave(10, phase);
    for (const float p : test::wave(10, 0.0).positions) both.positions.push_back(p + 20.0F);
    return both;
}

void expect_same_bricks(const EncodedFrame& frame, const EncodedFrame& expected) {
    ASSERT_EQ(frame.bricks.size(), expected.bricks.size());
    for (std::size_t i = 0; i < frame.bricks.size(); ++i) {
        ASSERT_EQ(frame.bricks[i]->messages.size(), expected.bricks[i]->messages.size());
        for (std::size_t m = 0; m < frame.bricks[i]->messages.size(); ++m)
            EXPECT_EQ(*frame.bricks[i]->messages[m], *expected.bricks[i]->messages[m]);
    }
}

TEST(FrameEncoder, EncodesOnlyTheBricksThatHaveChanged) {
    WorkerPool workers(2);
    ScratchPool scratch;
    const auto before = encode_frame(FrameOf(two_bodies(0.0)), {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
    const auto after =
        encode_frame(FrameOf(two_bodies(0.5)), {.normal_bits = 8}, before.get(), workers, scratch, nullptr);
    const auto anew = encode_frame(FrameOf(two_bodies(0.5)), {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
    expect_same_bricks(*after, *anew);
    std::size_t reused = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < after->bricks.size(); ++i) {
        const SharedBrick& brick = after->bricks[i];
        const bool is_reused = std::ranges::count(before->bricks, brick) != 0;
        const bool is_far = brick->place[0] >= 2;
        EXPECT_TRUE(is_reused || !is_far);
        reused += is_reused ? 1U : 0U;
        far += is_far ? 1U : 0U;
    }
    EXPECT_GT(far, 0U);
    EXPECT_LT(reused, after->bricks.size());
}

TEST(FrameEncoder, SendsWhatTheDeviceHasPackedAndBringsNoMeshDownForIt) {
    WorkerPool workers(1);
    ScratchPool scratch;
    const FrameOf on_cpu(test::wave(12, 0.0));
    FrameOf frame(test::wave(12, 0.0));
    const auto asked_for = std::make_shared<test::AskedFor>();
    frame.download = MeshDownload(std::make_shared<test::PackingMesh>(asked_for, frame.mesh));
    for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy}) {
        const MeshFormat format{.normal_bits = 8, .codec = codec};
        const auto encoded = encode_frame(frame, format, nullptr, workers, scratch, nullptr);
        expect_same_bricks(*encoded, *encode_frame(on_cpu, format, nullptr, workers, scratch, nullptr));
        EXPECT_EQ(parsed(encoded->begin).mesh_begin().brick_count(), on_cpu.mesh.bricks.size());
    }
    EXPECT_EQ(asked_for->meshes, 0);
    const MeshFormat draco{.normal_bits = 8};
    expect_same_bricks(*encode_frame(frame, draco, nullptr, workers, scratch, nullptr),
                       *encode_frame(on_cpu, draco, nullptr, workers, scratch, nullptr));
    EXPECT_EQ(asked_for->meshes, 1);
}

TEST(FrameEncoder, BringsOnlyPackedBricksDownThatTheFrameBeforeLacks) {
    WorkerPool workers(1);
    ScratchPool scratch;
    const auto asked_for = std::make_shared<test::AskedFor>();
    const auto encode = [&](double phase, const EncodedFrame* before) {
        FrameOf frame(two_bodies(phase));
        frame.download = MeshDownload(std::make_shared<test::PackingMesh>(asked_for, frame.mesh));
        asked_for->bricks.clear();
        return encode_frame(frame, {.normal_bits = 8, .codec = Codec::lattice_packed}, before, workers, scratch,
                            nullptr);
    };
    const auto before = encode(0.0, nullptr);
    EXPECT_EQ(asked_for->bricks.size(), before->bricks.size());
    const auto after = encode(0.5, before.get());
    ASSERT_FALSE(asked_for->bricks.empty());
    ASSERT_LT(asked_for->bricks.size(), after->bricks.size());
    for (std::size_t i = 0; i < after->bricks.size(); ++i) {
        const bool is_known = std::ranges::count(before->bricks, after->bricks[i]) != 0;
        EXPECT_EQ(std::ranges::count(asked_for->bricks, i), is_known ? 0 : 1);
    }
    expect_same_bricks(*after, *encode(0.5, nullptr));
}

TEST(FrameEncoder, ChargesItsTablesForAsLongAsTheirOwnerKeepsThem) {
    const auto account = std::make_shared<MemoryAccount>();
    WorkerPool workers(2);
    const FrameOf frame(test::wave(12, 0.0));
    {
        ScratchPool scratch(account);
        encode_frame(frame, {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
        EXPECT_GT(account->bytes(), 0U);
        const std::size_t bytes = account->bytes();
        encode_frame(frame, {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
        EXPECT_LE(account->bytes(), 2 * bytes);  // at most one table for each thread
    }
    EXPECT_EQ(account->bytes(), 0U);
}

TEST(FrameEncoder, NeedsTablesAsLargeAsABrickHoweverLargeTheMesh) {
    const auto peak = [](const test::Particles& particles) {
        const auto account = std::make_shared<MemoryAccount>();
        WorkerPool workers(1);
        ScratchPool scratch(account);
        encode_frame(FrameOf(particles), {.normal_bits = 8}, nullptr, workers, scratch, nullptr);
        return account->peak_bytes();
    };
    const test::Particles one = test::wave(10, 0.0);
    test::Particles many = one;
    for (const float distance : {20.0F, 40.0F, 60.0F, 80.0F})
        for (const float p : one.positions) many.positions.push_back(p + distance);
    // Other bodies lie otherwise in their bricks.
    EXPECT_LE(peak(many), 2 * peak(one));
}

}  // namespace
}  // namespace meniscus::server
