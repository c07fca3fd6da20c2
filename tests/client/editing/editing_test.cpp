// The changes to particles before they are reconstructed, and to meshes before they are written.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "compare/closedness.hpp"
#include "editing/mesh_box.hpp"
#include "editing/origin.hpp"
#include "editing/particle_box.hpp"
#include "editing/quads.hpp"
#include "formats/bytes/byte_cursor.hpp"

namespace meniscus::editing {
namespace {

using formats::NamedValues;
using formats::Particles;
using formats::TriangleMesh;

/// One byte each, which names the particle or the vertex.
NamedValues labels(std::size_t count) {
    NamedValues values{"label", ElementType::uint8, 1, {}};
    for (std::size_t i = 0; i < count; ++i) values.data.push_back(static_cast<std::byte>(i));
    return values;
}

Particles row_of_particles() {
    Particles particles;
    for (int i = 0; i < 6; ++i) {
        particles.positions.insert(particles.positions.end(), {static_cast<float>(i), 0.0F, 0.0F});
        particles.levels.push_back(static_cast<std::uint8_t>(i % 4));
    }
    particles.arrays.push_back(labels(6));
    return particles;
}

TEST(ParticleBox, KeepsThoseInsideAndOnItsBorderWithAllThatTheyCarry) {
    Particles particles = row_of_particles();
    keep_inside(particles, {{1.0, -1.0, 0.0}, {3.0, 1.0, 0.0}});
    EXPECT_EQ(particles.positions, (std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0}));
    EXPECT_EQ(particles.levels, (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_EQ(particles.arrays[0].data, (std::vector{std::byte{1}, std::byte{2}, std::byte{3}}));
}

TEST(ParticleBox, MayHoldAllOrNone) {
    Particles particles = row_of_particles();
    keep_inside(particles, {{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}});
    EXPECT_EQ(particles.positions, row_of_particles().positions);
    keep_inside(particles, {{0.5, 0.0, 0.0}, {0.6, 0.0, 0.0}});
    EXPECT_EQ(particles.count(), 0U);
    EXPECT_TRUE(particles.levels.empty());
    EXPECT_TRUE(particles.arrays[0].data.empty());
}

TEST(ParticleBox, LeavesParticlesWithoutAPlaceToTheCheckThatRefusesThem) {
    Particles particles = row_of_particles();
    particles.positions[3] = std::numeric_limits<float>::quiet_NaN();
    particles.positions[6] = std::numeric_limits<float>::infinity();
    keep_inside(particles, {{4.5, -1.0, -1.0}, {9.0, 1.0, 1.0}});
    ASSERT_EQ(particles.count(), 3U);
    EXPECT_TRUE(std::isnan(particles.positions[0]));
    EXPECT_TRUE(std::isinf(particles.positions[3]));
    EXPECT_EQ(particles.positions[6], 5.0F);
}

/// The unit squares from x = 0 to `columns` in the plane z = 0, each cut into two triangles that run counter-clockwise
/// seen from above; `height` lifts the vertices.
template <class Height>
TriangleMesh strip(std::uint32_t columns, Height height) {
    TriangleMesh mesh;
    for (std::uint32_t x = 0; x <= columns; ++x)
        for (std::uint32_t y = 0; y < 2; ++y) mesh.positions.push_back({double(x), double(y), height(x, y)});
    for (std::uint32_t x = 0; x < columns; ++x) {
        const std::uint32_t v = 2 * x;
        mesh.triangles.push_back({v, v + 2, v + 3});
        mesh.triangles.push_back({v, v + 3, v + 1});
    }
    mesh.levels.assign(mesh.triangles.size(), 3);
    return mesh;
}
TriangleMesh flat_strip(std::uint32_t columns) {
    return strip(columns, [](std::uint32_t, std::uint32_t) { return 0.0; });
}

TEST(MeshBox, KeepsWholeTrianglesWithACornerInside) {
    TriangleMesh mesh = flat_strip(4);
    mesh.levels = {1, 2, 3, 0, 1, 2, 3, 0};
    mesh.attributes.push_back(labels(10));
    for (std::size_t v = 0; v < 10; ++v) mesh.normals.push_back({static_cast<float>(v), 0.0F, 1.0F});
    keep_touching(mesh, {{1.0, 1.0, -1.0}, {1.5, 1.5, 1.0}});  // vertex 3 alone
    // The triangles 0 and 1 of the first square, and the second of the next one.
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 3}, {0, 3, 1}, {2, 4, 3}}));
    EXPECT_EQ(mesh.levels, (std::vector<std::uint8_t>{1, 2, 0}));
    const std::vector<std::uint8_t> kept{0, 1, 2, 3, 5};
    ASSERT_EQ(mesh.positions.size(), kept.size());
    for (std::size_t v = 0; v < kept.size(); ++v) {
        EXPECT_EQ(mesh.attributes[0].data[v], std::byte{kept[v]});
        EXPECT_EQ(mesh.normals[v][0], static_cast<float>(kept[v]));
        const int x = kept[v] / 2;
        EXPECT_EQ(mesh.positions[v][0], static_cast<double>(x));
    }
}

TEST(MeshBox, LeavesNothingOfAMeshOutside) {
    TriangleMesh mesh = flat_strip(2);
    mesh.attributes.push_back(labels(6));
    keep_touching(mesh, {{5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}});
    EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty() && mesh.levels.empty());
    EXPECT_TRUE(mesh.attributes[0].data.empty());
}

/// The triangles of a mesh, its quadrilaterals cut by the diagonal from their second corner; each from its smallest
/// index on.
std::set<Triangle> as_triangles(const TriangleMesh& mesh) {
    std::set<Triangle> all;
    const auto add = [&](Triangle t) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        all.insert(t);
    };
    for (const Triangle& t : mesh.triangles) add(t);
    for (const formats::Quad& q : mesh.quads) {
        add({q[0], q[1], q[3]});
        add({q[2], q[3], q[1]});
    }
    return all;
}

TEST(Quads, AreMadeOfAllPairsOfAFlatStripAndKeepTheSurfaceAndItsOrientation) {
    const TriangleMesh before = flat_strip(5);
    TriangleMesh mesh = before;
    merge_to_quads(mesh);
    EXPECT_EQ(mesh.quads.size(), 5U);
    EXPECT_TRUE(mesh.triangles.empty() && mesh.levels.empty());
    EXPECT_EQ(mesh.quad_levels, std::vector<std::uint8_t>(5, 3));
    EXPECT_EQ(as_triangles(mesh), as_triangles(before));
    for (const formats::Quad& q : mesh.quads) {
        double twice_area = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& a = mesh.positions[q[i]];
            const auto& b = mesh.positions[q[(i + 1) % 4]];
            twice_area += a[0] * b[1] - a[1] * b[0];
        }
        EXPECT_EQ(twice_area, 2.0) << "counter-clockwise, of area 1";
    }
}

TEST(Quads, AreNotMadeAcrossABendOrALevel) {
    TriangleMesh bent = strip(1, [](std::uint32_t x, std::uint32_t y) { return x == 1 && y == 0 ? 0.3 : 0.0; });
    merge_to_quads(bent);
    EXPECT_TRUE(bent.quads.empty());
    EXPECT_EQ(bent.triangles.size(), 2U);
    TriangleMesh levels = flat_strip(1);
    levels.levels = {1, 2};
    merge_to_quads(levels);
    EXPECT_TRUE(levels.quads.empty());
    EXPECT_EQ(levels.levels, (std::vector<std::uint8_t>{1, 2}));
}

TEST(Quads, AreConvexAndNotStretched) {
    TriangleMesh arrow;  // the second triangle's far corner lies where the whole is not convex
    arrow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.9, 0.9, 0}, {-0.5, -0.6, 0}};
    arrow.triangles = {{0, 1, 2}, {0, 4, 1}};
    merge_to_quads(arrow);
    EXPECT_TRUE(arrow.quads.empty());
    TriangleMesh stretched = flat_strip(1);
    for (auto& p : stretched.positions) p[0] *= 4.0;
    merge_to_quads(stretched);
    EXPECT_TRUE(stretched.quads.empty());
}

TEST(Quads, LeaveEdgesOfMoreThanTwoTrianglesAndTrianglesThatRunAgainstEachOther) {
    TriangleMesh crowded = flat_strip(1);
    crowded.positions.push_back({0.5, 0.5, 1.0});
    crowded.triangles.push_back({0, 3, 4});
    crowded.levels.push_back(3);
    merge_to_quads(crowded);
    EXPECT_TRUE(crowded.quads.empty());
    TriangleMesh flipped = flat_strip(1);
    std::swap(flipped.triangles[1][0], flipped.triangles[1][1]);
    merge_to_quads(flipped);
    EXPECT_TRUE(flipped.quads.empty());
}

TEST(Quads, TakeEachTriangleOnceThoseNearestToRightAnglesFirst) {
    // Three triangles in a row: the first two make a square, the last two a slanted one.
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.45, 1.8, 0}};
    mesh.triangles = {{3, 2, 4}, {0, 2, 3}, {0, 1, 2}};
    merge_to_quads(mesh);
    ASSERT_EQ(mesh.quads.size(), 1U);
    std::array<std::uint32_t, 4> corners = mesh.quads[0];
    std::sort(corners.begin(), corners.end());
    EXPECT_EQ(corners, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{3, 2, 4}}));
}

TEST(FarCoordinates, AreWhatTheFileSaysLessTheOriginAndComeBack) {
    const Origin origin{4'600'000.0, -500'000.0, 0.0};
    const formats::ByteCursor nowhere("file", "");
    Particles particles;
    for (int i = 0; i < 30; ++i)
        formats::set_coordinate(particles, particles.positions.size(),
                                origin[static_cast<std::size_t>(i % 3)] + i / 1024.0, nowhere);
    EXPECT_EQ(particles.remainders.size(), 30U);
    EXPECT_GT(largest_remainder(particles), 0.01);
    EXPECT_EQ(middle_of(particles), origin);
    move_to(particles, origin);
    for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(particles.positions[i], static_cast<float>(i) / 1024.0F);
    EXPECT_EQ(largest_remainder(particles), 0.0);
    TriangleMesh mesh = flat_strip(1);
    move_from(mesh, origin);
    EXPECT_TRUE(mesh.wide);
    EXPECT_EQ(mesh.positions[3], (std::array<double, 3>{4'600'001.0, -499'999.0, 0.0}));
}

TEST(FarCoordinates, TakeNoMemoryWhereFloat32HoldsThem) {
    const formats::ByteCursor nowhere("file", "");
    Particles particles;
    for (const double x : {0.5, 1e30, -0.25})
        formats::set_coordinate(particles, particles.positions.size(), x, nowhere);
    // 1e30 is no float32.
    EXPECT_EQ(particles.remainders.size(), 3U);
    Particles exact;
    for (const double x : {0.5, 0x1p100, -0.25}) formats::set_coordinate(exact, exact.positions.size(), x, nowhere);
    EXPECT_TRUE(exact.remainders.empty());
    // In any order, as columns of a file come.
    Particles columns;
    columns.positions.resize(6);
    for (const std::size_t i : {0, 3, 1, 4, 2, 5}) formats::set_coordinate(columns, i, i == 3 ? 0.1 : 1.0, nowhere);
    ASSERT_EQ(columns.remainders.size(), 6U);
    EXPECT_EQ(columns.coordinate(3), static_cast<double>(0.1F) + static_cast<double>(columns.remainders[3]));
    EXPECT_NEAR(columns.coordinate(3), 0.1, 1e-15);
}

TEST(ParticleBox, GoesByTheCoordinatesOfTheFile) {
    const formats::ByteCursor nowhere("file", "");
    Particles particles;
    for (const double x : {16'777'216.0, 16'777'217.0, 16'777'218.0})
        for (const double coordinate : {x, 0.0, 0.0})
            formats::set_coordinate(particles, particles.positions.size(), coordinate, nowhere);
    keep_inside(particles, {{16'777'216.5, 0.0, 0.0}, {16'777'217.5, 0.0, 0.0}});
    ASSERT_EQ(particles.count(), 1U);
    EXPECT_EQ(particles.coordinate(0), 16'777'217.0);
}

}  // namespace
}  // namespace meniscus::editing
