#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

#include "formats/brick_file.hpp"
#include "formats/byte_cursor.hpp"
#include "formats/mesh_file.hpp"
#include "meniscus/canonical_order.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

void expect_same(const formats::TriangleMesh& read, const Mesh& mesh) {
    ASSERT_EQ(read.positions.size(), mesh.vertices.size());
    for (std::size_t i = 0; i < read.positions.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(read.positions[i][a], mesh.world(mesh.vertices[i])[a]);
    ASSERT_EQ(read.normals.size(), mesh.normals.size());
    EXPECT_TRUE(std::equal(read.normals.begin(), read.normals.end(), mesh.normals.begin()));
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    EXPECT_TRUE(std::equal(read.triangles.begin(), read.triangles.end(), mesh.triangles.begin()));
    EXPECT_EQ(read.levels, (std::vector<std::uint8_t>{1, 2, 3, 0}));
}

TEST(MeshWriters, AreReadBackWithNormalsAndLevels) {
    const TemporaryDirectory directory;
    const Mesh mesh = tetrahedron();
    formats::write_ply(directory / "m.ply", mesh);
    expect_same(formats::read_mesh(directory / "m.ply"), mesh);
    formats::write_obj(directory / "m.obj", mesh);
    expect_same(formats::read_mesh(directory / "m.obj"), mesh);
}

TEST(MeshWriters, WriteAnEmptyMesh) {
    const TemporaryDirectory directory;
    for (const char* name : {"m.ply", "m.obj"}) {
        const auto path = directory / name;
        if (path.extension() == ".ply")
            formats::write_ply(path, Mesh{});
        else
            formats::write_obj(path, Mesh{});
        EXPECT_TRUE(formats::read_mesh(path).triangles.empty());
    }
}

TEST(MeshWriters, KeepNeighboringLatticePointsApartFarFromTheOrigin) {
    const TemporaryDirectory directory;
    // The coordinates are multiples of a length that is no power of two, where float32 steps matter most.
    for (const std::int32_t origin : {0, (1 << 23) - 20, 1 << 23, (1 << 24) - 20, 1 << 30, -(1 << 24)}) {
        Mesh mesh;
        mesh.cell_size = 64.0 * 1.0001 / 3.0;
        mesh.offset_bits = 6;
        for (std::int32_t i = 0; i < 19; ++i) mesh.vertices.push_back({origin + i, 0, 0});
        formats::write_ply(directory / "m.ply", mesh);
        formats::write_obj(directory / "m.obj", mesh);
        for (const char* name : {"m.ply", "m.obj"}) {
            std::set<double> distinct;
            for (const auto& p : formats::read_mesh(directory / name).positions) distinct.insert(p[0]);
            EXPECT_EQ(distinct.size(), 19U) << name << " at " << origin;
        }
    }
}

TEST(MeshWriters, UseFloat32WhereItSuffices) {
    EXPECT_FALSE(formats::needs_double(tetrahedron((1 << 23) - 100)));
    EXPECT_TRUE(formats::needs_double(tetrahedron(1 << 23)));
}

TEST(PlyMeshReader, CutsPolygonsIntoFans) {
    const auto mesh =
        formats::read_mesh_ply("f",
                               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
    EXPECT_TRUE(mesh.levels.empty());
}

TEST(MeshReaders, RefuseAFaceBeyondTheVertices) {
    EXPECT_NE(refusal([] { formats::read_obj("f", "v 0 0 0\nf 1 1 2\n"); }).find("vertex 1 of 1"), std::string::npos);
    EXPECT_NE(refusal([] { formats::read_obj("f", "v 0 0 0\nf 1 1 -2\n"); }), "");
}

TEST(MeshReaders, RefuseWhatIsNoMesh) {
    EXPECT_NE(refusal([] { formats::read_obj("f", "hello world\n"); }).find("'hello'"), std::string::npos);
    EXPECT_NE(refusal([] { formats::read_mesh("a.stl"); }).find("'.stl'"), std::string::npos);
}

TEST(BrickFile, IsReadBackInParts) {
    const TemporaryDirectory directory;
    client::ReceivedFrame frame;
    frame.index = 7;
    frame.simulation_time = 0.25;
    frame.cell_size = 0.0125;
    frame.offset_bits = 6;
    frame.statistics.triangles = 7;
    frame.statistics.stage_seconds[7] = 0.5;
    frame.statistics.backend = "cpu";
    frame.bricks.push_back(std::make_shared<EncodedBrick>(EncodedBrick{{0, 0, 0}, 1, 1, {}, {}}));
    frame.bricks.push_back(std::make_shared<EncodedBrick>(
        EncodedBrick{{-1, 2, 3}, 5, 6, {std::byte{3}}, std::vector<std::byte>((1 << 21) + 5, std::byte{9})}));
    frame.spray = {{1.0F, -2.0F, 3.5F}, {4.0F, 5.0F, 6.0F}};
    formats::write_bricks(directory / "f.bricks", frame);
    const auto back = formats::read_bricks("f", formats::read_file(directory / "f.bricks"));
    EXPECT_EQ(back.index, 7U);
    EXPECT_EQ(back.simulation_time, 0.25);
    EXPECT_EQ(back.cell_size, 0.0125);
    EXPECT_EQ(back.offset_bits, 6U);
    EXPECT_EQ(back.spray, frame.spray);
    ASSERT_EQ(back.bricks.size(), 2U);
    EXPECT_EQ(back.bricks[1]->coordinate, frame.bricks[1]->coordinate);
    EXPECT_EQ(back.bricks[1]->cell_levels, frame.bricks[1]->cell_levels);
    EXPECT_EQ(back.bricks[1]->data, frame.bricks[1]->data);
    EXPECT_EQ(back.statistics.triangles, 7U);
    EXPECT_EQ(back.statistics.stage_seconds[7], 0.5);
    EXPECT_EQ(back.statistics.backend, "cpu");
    EXPECT_TRUE(back.attributes.empty());
}

TEST(BrickFile, HasTheAttributesOfItsMesh) {
    const TemporaryDirectory directory;
    Mesh mesh = tetrahedron();
    mesh.bricks.push_back({{0, 0, 0}, mesh.levels});
    const std::vector<float> speeds{0.25F, 0.5F, 1.0F, 8.25F};
    MeshAttribute& speed = mesh.attributes.emplace_back();
    speed.name = "speed";
    speed.data.assign(std::as_bytes(std::span(speeds)).begin(), std::as_bytes(std::span(speeds)).end());
    const AttributeWish exactly{"speed", 0};
    CodingOptions options;
    options.attributes = coded_attributes(mesh, attribute_ranges(mesh), {&exactly, 1});
    formats::write_bricks(directory / "f.bricks", formats::encode_frame(mesh, {}, 1, 0.0, options));
    const auto back = formats::read_bricks("f", formats::read_file(directory / "f.bricks"));
    ASSERT_EQ(back.attributes.size(), 1U);
    EXPECT_EQ(back.attributes[0].range->maximum[0], 8.25);
    EXPECT_EQ(back.coded_attributes, options.attributes);
    const Mesh read = in_canonical_order(back.mesh());
    const Mesh expected = in_canonical_order(mesh);
    ASSERT_EQ(read.attributes.size(), 1U);
    EXPECT_TRUE(read.attributes[0].data == expected.attributes[0].data);
}

}  // namespace
}  // namespace meniscus::test
