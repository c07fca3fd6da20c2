// Normals that a receiver computes, however meshes reach it.
#include <gtest/gtest.h>

#include <string>

#include "meniscus/error.hpp"
#include "meniscus/mesh_normals.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

using client::NormalsBy;
using client::ReceivedFrame;

/// Fails unless the frame's bricks carry no normals and its mesh has those of its triangles.
void expect_its_own_normals(const ReceivedFrame& frame) {
    ASSERT_GT(frame.bricks.size(), 1U);
    for (const auto& brick : frame.bricks) EXPECT_TRUE(decode_brick(*brick, frame.offset_bits).normals.empty());
    Mesh mesh = frame.mesh();
    const Array<Normal> normals = mesh.normals;
    EXPECT_EQ(normals.size(), mesh.vertices.size());
    compute_normals(mesh);
    EXPECT_EQ(normals, mesh.normals);
}

void expect_its_own_normals_of_every_kind(RunningServer& running, const std::string& id) {
    // Bits that no server takes do not count.
    auto stream = running.client.stream(id, {.normal_bits = 17, .normals_by = NormalsBy::receiver});
    stream.push(spray(20).view(), 0, 0.0);
    const auto streamed = stream.next();
    ASSERT_TRUE(streamed);
    expect_its_own_normals(*streamed);
    auto watcher = running.client.watch(id, {.normals_by = NormalsBy::receiver});
    const auto watched = watcher.next();
    ASSERT_TRUE(watched);
    expect_its_own_normals(*watched);
    const auto snapshot = running.client.snapshot(id, {.normals_by = NormalsBy::receiver, .max_level = 2});
    ASSERT_TRUE(snapshot);
    expect_its_own_normals(*snapshot);
}

TEST(NormalsByReceiver, AreThoseOfTheTrianglesAndNoneAreSent) {
    RunningServer running;
    const std::string id = running.session();
    expect_its_own_normals_of_every_kind(running, id);
    auto watcher = running.client.watch(id);
    EXPECT_NE(watcher.next()->mesh().normals,
              running.client.snapshot(id, {.normals_by = NormalsBy::receiver})->mesh().normals);
}

TEST(NormalsByReceiver, AreThereThoughTheSessionHasNone) {
    RunningServer running;
    const std::string id = client::new_session_id();
    Settings without = settings();
    without.normals = false;
    running.client.create_session(id, without);
    expect_its_own_normals_of_every_kind(running, id);
    EXPECT_TRUE(running.client.snapshot(id)->mesh().normals.empty());
}

}  // namespace
}  // namespace meniscus::server::test
