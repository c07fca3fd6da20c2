// The options of watchers: the frames that they give, and those that are refused.
#include "rpc/messages/watch_options.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "compare/closedness.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

v1::WatchRequest request(const std::function<void(v1::WatchRequest&)>& change) {
    v1::WatchRequest message;
    change(message);
    return message;
}

void expect_refused(const std::string& part, const std::function<void(v1::WatchRequest&)>& change) {
    try {
        watch_options_of(request(change), settings());
        ADD_FAILURE() << part;
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

/// From 0 to 1, but on the x axis.
void set_region(v1::WatchRequest& message, double low, double high) {
    v1::Vector3& min = *message.mutable_region()->mutable_min();
    v1::Vector3& max = *message.mutable_region()->mutable_max();
    min.set_x(low);
    max.set_x(high);
    max.set_y(1.0);
    max.set_z(1.0);
}

TEST(WatchOptions, AreRefusedOutOfRangeWithValueAndLimit) {
    expect_refused("normal_bits is 1;", [](auto& m) { m.set_normal_bits(1); });
    expect_refused("normal_bits is 17;", [](auto& m) { m.set_normal_bits(17); });
    expect_refused("position_bits is 1; it must be 2 to 6", [](auto& m) { m.set_position_bits(1); });
    expect_refused("position_bits is 7; it must be 2 to 6", [](auto& m) { m.set_position_bits(7); });
    expect_refused("max_level is 0; it must be 1 to 3", [](auto& m) { m.set_max_level(0); });
    expect_refused("max_level is 4; it must be 1 to 3", [](auto& m) { m.set_max_level(4); });
    expect_refused("region", [](auto& m) { m.mutable_region(); });
    expect_refused("region runs from 1 to 1 on the x axis", [](auto& m) { set_region(m, 1.0, 1.0); });
    expect_refused("on the x axis", [](auto& m) { set_region(m, std::numeric_limits<double>::quiet_NaN(), 1.0); });
    expect_refused("on the x axis", [](auto& m) { set_region(m, 0.0, std::numeric_limits<double>::infinity()); });
    expect_refused("viewpoint is (inf",
                   [](auto& m) { m.mutable_viewpoint()->set_x(std::numeric_limits<double>::infinity()); });
}

TEST(WatchOptions, ForNormalsAreRefusedOutOfRangeAlsoWhereThereAreNone) {
    Settings without_normals = settings();
    without_normals.normals = false;
    v1::SnapshotRequest snapshot;
    snapshot.set_normal_bits(17);
    EXPECT_THROW(watch_options_of(snapshot, without_normals), InvalidInput);
    EXPECT_THROW(watch_options_of(request([](auto& m) { m.set_normal_bits(1); }), without_normals), InvalidInput);
    EXPECT_EQ(watch_options_of(request([](auto& m) { m.set_normal_bits(16); }), without_normals).format.normal_bits, 0);
}

TEST(WatchOptions, AreTakenOnTheirLimits) {
    for (const std::uint32_t bits : {0U, 2U, 16U})
        EXPECT_EQ(watch_options_of(request([&](auto& m) { m.set_normal_bits(bits); }), settings()).format.normal_bits,
                  static_cast<int>(bits));
    for (const std::uint32_t bits : {2U, 6U})
        EXPECT_EQ(
            watch_options_of(request([&](auto& m) { m.set_position_bits(bits); }), settings()).format.position_bits,
            static_cast<int>(bits));
    for (const std::uint32_t level : {1U, 3U})
        EXPECT_EQ(watch_options_of(request([&](auto& m) { m.set_max_level(level); }), settings()).format.max_level,
                  static_cast<int>(level));
    EXPECT_TRUE(watch_options_of(request([](auto& m) { set_region(m, -1e300, 1e300); }), settings()).region);
}

TEST(WatchOptions, ShareAnEncodeWhereTheyComeToTheSame) {
    const MeshFormat plain = watch_options_of(v1::WatchRequest(), settings()).format;
    const auto spelled_out = [](auto& m) {
        m.set_position_bits(6);
        m.set_max_level(3);
        m.set_normal_bits(8);
        m.set_bytes_per_second(1);
        m.mutable_viewpoint();
        set_region(m, 0.0, 1.0);
    };
    EXPECT_EQ(watch_options_of(request(spelled_out), settings()).format, plain);
    Settings without_normals = settings();
    without_normals.normals = false;
    EXPECT_EQ(watch_options_of(v1::WatchRequest(), without_normals).format,
              watch_options_of(request([](auto& m) { m.set_normal_bits(0); }), settings()).format);
}

struct WatcherOfAFrame : testing::Test {
    WatcherOfAFrame() : stream(running.client.stream(id, {.receive_meshes = false})) {
        stream.push(particles.view(), 0, 0.0);
        stream.next();
    }

    RunningServer running;
    const std::string id = running.session();
    const Particles particles = wave(12, 0.0);
    client::Stream stream;
};

compare::Defects defects(const Mesh& mesh) {
    std::vector<compare::Point> points;
    for (const LatticePosition& vertex : mesh.vertices) points.push_back(mesh.world(vertex));
    return compare::find_defects({.positions = points, .triangles = mesh.triangles});
}

TEST_F(WatcherOfAFrame, GetsAClosedMeshForAllOptions) {
    Mesh full;
    for (const int max_level : {3, 2, 1})
        for (int position_bits = 6; position_bits >= 2; --position_bits) {
            SCOPED_TRACE(std::to_string(max_level) + ", " + std::to_string(position_bits));
            auto watcher = running.client.watch(id, {.position_bits = position_bits, .max_level = max_level});
            const auto frame = watcher.next();
            EXPECT_EQ(frame->offset_bits, static_cast<std::uint32_t>(position_bits));
            const Mesh mesh = frame->mesh();
            EXPECT_TRUE(defects(mesh).closed()) << defects(mesh).text();
            EXPECT_FALSE(mesh.normals.empty());
            if (max_level == 3 && position_bits == 6) full = mesh;
            // Coarser positions move vertices, and by less than their step; they take none away.
            if (max_level == 3) {
                EXPECT_EQ(mesh.vertices.size(), full.vertices.size());
                EXPECT_EQ(mesh.triangles.size(), full.triangles.size());
            } else {
                EXPECT_EQ(mesh.levels[2].count, 0U);
                EXPECT_LT(mesh.triangles.size(), full.triangles.size());
            }
        }
    EXPECT_EQ(mesh_sha256(full), local_sha256(particles));
}

TEST_F(WatcherOfAFrame, GetsFewerBytesForFewerBits) {
    const auto bytes = [&](const client::WatchOptions& options) {
        return running.client.watch(id, options).next()->statistics.encoded_bytes;
    };
    EXPECT_LT(bytes({.position_bits = 2}), bytes({}));
    EXPECT_LT(bytes({.normal_bits = 0}), bytes({.normal_bits = 4}));
    EXPECT_LT(bytes({.max_level = 1}), bytes({}));
}

TEST_F(WatcherOfAFrame, GetsTheBricksThatTouchItsRegion) {
    const auto all = running.client.watch(id).next();
    const Box region{{0.5, 1.0, -3.0}, {3.0, 2.0, 0.25}};
    const double edge = brick_cells * all->cell_size;
    std::vector<std::array<std::int32_t, 3>> expected;
    for (const auto& brick : all->bricks) {
        bool touches = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
            touches = touches && brick->coordinate[axis] * edge <= region.max[axis] &&
                      (brick->coordinate[axis] + 1) * edge >= region.min[axis];
        if (touches) expected.push_back(brick->coordinate);
    }
    ASSERT_FALSE(expected.empty());
    ASSERT_LT(expected.size(), all->bricks.size());
    const auto part = running.client.watch(id, {.region = region}).next();
    std::vector<std::array<std::int32_t, 3>> received;
    for (const auto& brick : part->bricks) received.push_back(brick->coordinate);
    EXPECT_EQ(received, expected);
    EXPECT_EQ(part->changed, expected);
}

TEST_F(WatcherOfAFrame, IsRefusedForAnOptionOutOfRange) {
    auto watcher = running.client.watch(id, {.position_bits = 7});
    EXPECT_THROW(watcher.next(), InvalidInput);
}

TEST_F(WatcherOfAFrame, WithARateStillGetsTheLastFrame) {
    auto watcher = running.client.watch(id, {.bytes_per_second = 60000});
    ASSERT_TRUE(watcher.next());
    for (std::uint64_t i = 1; i <= 5; ++i) stream.push(wave(12, static_cast<double>(i)).view(), i, 0.0);
    for (;;) {
        const auto frame = watcher.next();
        ASSERT_TRUE(frame);
        if (frame->index == 5) break;
    }
}

TEST_F(WatcherOfAFrame, EndsAtOnceWithItsSessionWhileItsRateHoldsTheNextFrameBack) {
    auto watcher = running.client.watch(id, {.bytes_per_second = 1});
    ASSERT_TRUE(watcher.next());
    stream.push(wave(12, 1.0).view(), 1, 0.0);
    stream.next();
    running.client.delete_session(id);
    while (watcher.next()) {
    }
}

}  // namespace
}  // namespace meniscus::server::test
