#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <span>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/meshes/mesh_readers.hpp"
#include "formats/meshes/mesh_writers.hpp"
#include "formats/meshes/pvd_writer.hpp"
#include "formats/particles/particle_writer.hpp"
#include "formats/recordings/brick_file.hpp"
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
    for (const char* name : {"m.ply", "m.obj", "m.vtk", "m.vtp", "m.npz"}) {
        const auto path = directory / name;
        formats::write_mesh(path, formats::to_triangles(Mesh{}), formats::mesh_format_of(path));
        EXPECT_TRUE(formats::read_mesh(path).triangles.empty());
    }
}

TEST(ReadMesh, RefusesAFileOfParticles) {
    const TemporaryDirectory directory;
    const std::vector<float> positions{0, 0, 0, 1, 0, 0};
    ParticleFrame frame;
    frame.positions = positions;
    formats::write_particle_ply(directory / "p.ply", frame);
    formats::write_particle_vtp(directory / "p.vtp", frame);
    for (const char* name : {"p.ply", "p.vtp"}) {
        const std::string message = refusal([&] { formats::read_mesh(directory / name); });
        EXPECT_NE(message.find("no triangles, and 2 points: "), std::string::npos) << message;
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
        mesh.triangles = {{0, 1, 2}};
        mesh.levels[0] = {0, 1};
        formats::write_ply(directory / "m.ply", mesh);
        formats::write_obj(directory / "m.obj", mesh);
        for (const char* name : {"m.ply", "m.obj"}) {
            std::set<double> distinct;
            for (const auto& p : formats::read_mesh(directory / name).positions) distinct.insert(p[0]);
            EXPECT_EQ(distinct.size(), 19U) << name << " at " << origin;
        }
    }
}

/// The tetrahedron with an attribute of every form.
formats::TriangleMesh with_attributes() {
    formats::TriangleMesh mesh = formats::to_triangles(tetrahedron());
    const auto add = [&](const std::string& name, ElementType type, std::size_t components) {
        formats::NamedValues values{name, type, components, {}};
        values.data.resize(4 * values.element_bytes());
        for (std::size_t i = 0; i < values.data.size(); ++i) values.data[i] = static_cast<std::byte>(i * 7 % 60);
        mesh.attributes.push_back(values);
    };
    add("age", ElementType::float32, 1);
    add("velocity", ElementType::float32, 3);
    add("spin", ElementType::float32, 4);
    add("phase", ElementType::uint8, 1);
    add("color", ElementType::uint8, 3);
    add("paint", ElementType::uint8, 4);
    add("shift", ElementType::int32, 1);
    add("id", ElementType::uint32, 1);
    return mesh;
}

void expect_equal(const formats::TriangleMesh& a, const formats::TriangleMesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.levels, b.levels);
    EXPECT_EQ(a.wide, b.wide);
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (std::size_t i = 0; i < a.attributes.size(); ++i) {
        EXPECT_EQ(a.attributes[i].name, b.attributes[i].name);
        EXPECT_EQ(a.attributes[i].type, b.attributes[i].type);
        EXPECT_EQ(a.attributes[i].components, b.attributes[i].components);
        EXPECT_EQ(a.attributes[i].data, b.attributes[i].data) << a.attributes[i].name;
    }
}

constexpr std::array formats_with_attributes{formats::MeshFormat::ply, formats::MeshFormat::vtk,
                                             formats::MeshFormat::vtp, formats::MeshFormat::npz};

TEST(MeshWriters, AttributesAreReadBack) {
    const TemporaryDirectory directory;
    const formats::TriangleMesh mesh = with_attributes();
    for (const formats::MeshFormat format : formats_with_attributes) {
        SCOPED_TRACE(name_of(format));
        const auto path = directory / ("m." + std::string(name_of(format)));
        formats::write_mesh(path, mesh, format);
        expect_equal(formats::read_mesh(path), mesh);
    }
    formats::write_mesh_vtp(directory / "z.vtp", mesh, {.compress = true});
    expect_equal(formats::read_mesh(directory / "z.vtp"), mesh);
}

TEST(MeshWriters, Float64PositionsAreReadBack) {
    const TemporaryDirectory directory;
    formats::TriangleMesh mesh = formats::to_triangles(tetrahedron(1 << 24));
    ASSERT_TRUE(mesh.wide);
    mesh.positions[0][0] = 1.0 / 3.0;
    for (const formats::MeshFormat format :
         {formats::MeshFormat::ply, formats::MeshFormat::obj, formats::MeshFormat::vtk, formats::MeshFormat::vtp,
          formats::MeshFormat::npz}) {
        SCOPED_TRACE(name_of(format));
        const auto path = directory / ("m." + std::string(name_of(format)));
        formats::write_mesh(path, mesh, format);
        expect_equal(formats::read_mesh(path), mesh);
    }
}

TEST(MeshWriters, OfAMeshAndOfItsTrianglesWriteTheSameBytes) {
    const TemporaryDirectory directory;
    Mesh mesh = tetrahedron();
    MeshAttribute age;
    age.name = "age";
    age.data.resize(4 * sizeof(float));
    mesh.attributes.push_back(age);
    formats::write_ply(directory / "a.ply", mesh);
    formats::write_ply(directory / "b.ply", formats::to_triangles(mesh));
    EXPECT_EQ(formats::read_file(directory / "a.ply"), formats::read_file(directory / "b.ply"));
    EXPECT_EQ(formats::read_mesh(directory / "a.ply").attributes.size(), 1U);
    formats::write_obj(directory / "a.obj", mesh);
    formats::write_obj(directory / "b.obj", formats::to_triangles(mesh));
    EXPECT_EQ(formats::read_file(directory / "a.obj"), formats::read_file(directory / "b.obj"));
}

TEST(MeshWriters, AttributesKeepOutOfTheWayOfNamesThatMeanSomethingElse) {
    const TemporaryDirectory directory;
    for (const auto& [name, format] : {std::pair{"x", formats::MeshFormat::ply},
                                       {"positions", formats::MeshFormat::npz},
                                       {"levels", formats::MeshFormat::npz}}) {
        formats::TriangleMesh mesh = formats::to_triangles(tetrahedron());
        mesh.attributes.push_back({name, ElementType::uint8, 1, std::vector<std::byte>(4, std::byte{9})});
        const auto path = directory / ("m." + std::string(name_of(format)));
        formats::write_mesh(path, mesh, format);
        const formats::TriangleMesh back = formats::read_mesh(path);
        EXPECT_EQ(back.positions, mesh.positions);
        EXPECT_EQ(back.levels, mesh.levels);
        ASSERT_EQ(back.attributes.size(), 1U);
        EXPECT_EQ(back.attributes[0].name, std::string(name) + "_");
    }
}

TEST(MeshWriters, TrianglesAreNoBricks) {
    EXPECT_NE(refusal([] { formats::write_mesh("m.bricks", {}, formats::MeshFormat::bricks); }).find("m.bricks"),
              std::string::npos);
}

TEST(MeshReaders, FormatsThatAreOnlyWrittenAreRefused) {
    const TemporaryDirectory directory;
    for (const char* name : {"m.glb", "m.usda"}) {
        std::ofstream(directory / name) << "x";
        EXPECT_NE(refusal([&] { formats::read_mesh(directory / name); }).find("is written, and not read"),
                  std::string::npos);
    }
}

TEST(VtkMeshReader, FacesOfEveryKindBecomeTriangles) {
    const std::string points = "POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n";
    const std::string head = "# vtk DataFile Version 4.1\nt\nASCII\nDATASET ";
    const auto of = [](const std::string& text) { return formats::read_mesh_vtk("f", text).triangles; };
    const std::vector<Triangle> both{{0, 1, 3}, {0, 3, 2}};
    EXPECT_EQ(of(head + "POLYDATA\n" + points + "POLYGONS 1 5\n4 0 1 3 2\n"), both);
    EXPECT_EQ(of(head + "POLYDATA\n" + points + "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n"),
              (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
    // A vertex, a line, a pixel and a quadrilateral.
    EXPECT_EQ(of(head + "UNSTRUCTURED_GRID\n" + points +
                 "CELLS 4 15\n1 0\n2 0 1\n4 0 1 2 3\n4 0 1 3 2\nCELL_TYPES 4\n1 3 8 9\n"),
              (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}, {0, 1, 3}, {0, 3, 2}}));
    std::string newer = head + "POLYDATA\n" + points;
    newer.replace(newer.find("4.1"), 3, "5.1");
    EXPECT_EQ(of(newer + "POLYGONS 3 6\nOFFSETS vtktypeint64\n0 3 6\nCONNECTIVITY vtktypeint64\n0 1 3 0 3 2\n"), both);
}

TEST(VtkMeshReader, LevelsOfCellsAreThoseOfTheirTriangles) {
    const auto mesh = formats::read_mesh_vtk(
        "f",
        "# vtk DataFile Version 4.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
        "VERTICES 1 2\n1 0\nPOLYGONS 2 9\n4 0 1 2 3\n3 0 1 2\nCELL_DATA 3\nSCALARS level int\n9 2 1\n");
    EXPECT_EQ(mesh.levels, (std::vector<std::uint8_t>{2, 2, 1}));
}

TEST(VtkMeshReader, CornersBeyondThePointsAreRefused) {
    const std::string head =
        "# vtk DataFile Version 4.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n";
    EXPECT_EQ(refusal([&] { formats::read_mesh_vtk("f", head + "3 0 0 1\n"); }), "f: a face uses vertex 1 of 1");
    EXPECT_NE(refusal([&] { formats::read_mesh_vtk("f", head + "9 0 0 0\n"); }).find("9.0"), std::string::npos);
    EXPECT_NE(refusal([&] { formats::read_mesh_vtk("f", head + "2 0 0 0\n"); }).find("follow the last cell"),
              std::string::npos);
}

TEST(Pvd, NamesFilesRelativeToItsFolderWithTheirTimes) {
    const TemporaryDirectory directory;
    formats::write_pvd(directory / "s.pvd",
                       std::vector<formats::PvdEntry>{{0.0, directory / "a.vtp"}, {0.1, directory / "b & c/d.vtp"}});
    const std::string text = formats::read_file(directory / "s.pvd");
    EXPECT_NE(text.find("<DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"a.vtp\" />"), std::string::npos) << text;
    EXPECT_NE(text.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"b &#38; c/d.vtp\""), std::string::npos) << text;
    // A folder that is named by way of another one.
    std::filesystem::create_directory(directory / "meshes");
    formats::write_pvd(directory / "meshes/../t.pvd",
                       std::vector<formats::PvdEntry>{{0.0, directory / "meshes/a.vtp"}});
    EXPECT_NE(formats::read_file(directory / "t.pvd").find("file=\"meshes/a.vtp\""), std::string::npos);
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
    EXPECT_NE(refusal([] { formats::read_mesh("a.off"); }).find("'.off'"), std::string::npos);
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
    // All of one level, as the triangles of a cell are.
    mesh.levels = {{{0, 4}, {4, 0}, {4, 0}, {4, 0}}};
    mesh.bricks.push_back({{0, 0, 0}, mesh.levels});
    const std::vector<float> speeds{0.25F, 0.5F, 1.0F, 8.25F};
    MeshAttribute& speed = mesh.attributes.emplace_back();
    speed.name = "speed";
    speed.data.assign(std::as_bytes(std::span(speeds)).begin(), std::as_bytes(std::span(speeds)).end());
    const AttributeWish exactly{"speed", 0};
    CodingOptions options;
    options.attributes = coded_attributes(mesh, attribute_ranges(mesh), {&exactly, 1});
    formats::write_bricks(directory / "f.bricks", client::encode_frame(mesh, {}, 1, 0.0, options));
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
