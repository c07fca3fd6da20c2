// One order and one rounding of normals, whichever way a mesh has come.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/has_draco.hpp"
#include "support/mesh_attributes.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

Mesh splash(Mode mode, bool normals = true) {
    Settings settings = test::default_settings();
    settings.mode = mode;
    settings.normals = normals;
    Reconstructor reconstructor(settings, {Backend::cpu, 1, 0});
    Mesh mesh;
    reconstructor.reconstruct(test::splash(61).frame(), mesh);
    test::add_attributes(mesh);
    return mesh;
}

/// The same surface with its vertices, the triangles of each level, and the corners of triangles in a random order.
Mesh shuffled(const Mesh& mesh, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> place(mesh.vertices.size());
    std::iota(place.begin(), place.end(), 0U);
    std::shuffle(place.begin(), place.end(), random);
    Mesh out = mesh;
    for (std::size_t v = 0; v < place.size(); ++v) {
        out.vertices[place[v]] = mesh.vertices[v];
        if (!mesh.normals.empty()) out.normals[place[v]] = mesh.normals[v];
        for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
            const std::size_t size = mesh.attributes[a].element_bytes();
            std::copy_n(mesh.attributes[a].data.begin() + static_cast<std::ptrdiff_t>(v * size), size,
                        out.attributes[a].data.begin() + static_cast<std::ptrdiff_t>(place[v] * size));
        }
    }
    for (Triangle& t : out.triangles) {
        for (std::uint32_t& v : t) v = place[v];
        std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    }
    for (const TriangleRange& range : out.levels)
        std::shuffle(out.triangles.begin() + range.first, out.triangles.begin() + range.first + range.count, random);
    return out;
}

void expect_equal(const Mesh& a, const Mesh& b) {
    EXPECT_TRUE(std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end()));
    EXPECT_TRUE(std::equal(a.normals.begin(), a.normals.end(), b.normals.begin(), b.normals.end()));
    EXPECT_TRUE(std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(), b.triangles.end()));
    for (std::size_t level = 0; level < triangle_level_count; ++level) {
        EXPECT_EQ(a.levels[level].first, b.levels[level].first);
        EXPECT_EQ(a.levels[level].count, b.levels[level].count);
    }
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (std::size_t i = 0; i < a.attributes.size(); ++i)
        EXPECT_TRUE(a.attributes[i].data == b.attributes[i].data) << a.attributes[i].name;
}

TEST(CanonicalOrder, IsThatOfPositionsAndKeepsTheSurface) {
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        const Mesh mesh = splash(mode);
        const Mesh ordered = in_canonical_order(mesh);
        EXPECT_EQ(mesh_sha256(ordered), mesh_sha256(mesh));
        EXPECT_TRUE(std::is_sorted(ordered.vertices.begin(), ordered.vertices.end()));
        for (const TriangleRange& range : ordered.levels) {
            const auto first = ordered.triangles.begin() + range.first;
            EXPECT_TRUE(std::is_sorted(first, first + range.count));
            for (auto t = first; t != first + range.count; ++t) {
                ASSERT_LT((*t)[0], (*t)[1]);
                ASSERT_LT((*t)[0], (*t)[2]);
            }
        }
    }
}

TEST(CanonicalOrder, IsTheSameForEveryOrderThatAMeshCanHave) {
    const Mesh mesh = splash(Mode::adaptive);
    const Mesh ordered = in_canonical_order(mesh);
    for (const unsigned seed : {1U, 2U, 3U}) {
        const Mesh other = shuffled(mesh, seed);
        expect_equal(in_canonical_order(other), ordered);
        EXPECT_EQ(mesh_sha256(other), mesh_sha256(mesh));
    }
}

TEST(CanonicalOrder, HoldsForCoordinatesAtTheEndsOfTheirRange) {
    constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    Mesh mesh;
    mesh.cell_size = 1.0;
    for (const std::int32_t x : {most, 0, least, -1, 2048, 1, 2047})
        for (const std::int32_t y : {0, least, most})
            for (const std::int32_t z : {least, most, 5}) mesh.vertices.push_back({x, y, z});
    const Mesh ordered = in_canonical_order(mesh);
    EXPECT_EQ(ordered.vertices.size(), mesh.vertices.size());
    EXPECT_TRUE(std::is_sorted(ordered.vertices.begin(), ordered.vertices.end()));
    EXPECT_TRUE(in_canonical_order(Mesh{}).vertices.empty());
}

/// The same by comparison, vertex by vertex and triangle by triangle.
Mesh sorted_by_comparison(const Mesh& mesh) {
    std::vector<std::uint32_t> order(mesh.vertices.size()), place(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return mesh.vertices[a] < mesh.vertices[b]; });
    Mesh sorted = mesh;
    for (std::uint32_t v = 0; v < order.size(); ++v) {
        sorted.vertices[v] = mesh.vertices[order[v]];
        place[order[v]] = v;
    }
    for (Triangle& t : sorted.triangles) {
        for (std::uint32_t& v : t) v = place[v];
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    }
    for (const auto& [first, count] : sorted.levels)
        std::sort(sorted.triangles.begin() + first, sorted.triangles.begin() + first + count);
    return sorted;
}

TEST(CanonicalOrder, IsThatOfComparisonHoweverVerticesLieAndTrianglesJoinThem) {
    std::mt19937 random(7);
    // Wide and flat along each axis: slices of x that are even, crowded, and one alone.
    for (const LatticePosition& extent :
         {LatticePosition{3000, 40, 40}, {1, 2000, 2000}, {40, 3000, 3}, {50, 50, 50}}) {
        Mesh mesh;
        mesh.cell_size = 1.0;
        for (int i = 0; i < 90'000; ++i) {
            LatticePosition p;
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[axis] = static_cast<std::int32_t>(random() % static_cast<unsigned>(extent[axis])) - extent[axis] / 2;
            mesh.vertices.push_back(p);
        }
        std::sort(mesh.vertices.begin(), mesh.vertices.end());
        mesh.vertices.erase(std::unique(mesh.vertices.begin(), mesh.vertices.end()), mesh.vertices.end());
        std::shuffle(mesh.vertices.begin(), mesh.vertices.end(), random);
        const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
        ASSERT_GT(count, 2U << 14) << "several slices";
        for (std::size_t level = 0; level < triangle_level_count; ++level) {
            // No triangle of level 2; all of the cracks at a few vertices.
            const std::uint32_t triangles = level == 1 ? 0 : 40'000;
            const std::uint32_t vertices = level == 3 ? 100 : count;
            mesh.levels[level] = {static_cast<std::uint32_t>(mesh.triangles.size()), triangles};
            for (std::uint32_t i = 0; i < triangles; ++i) {
                const auto first = static_cast<std::uint32_t>(random() % vertices);
                const auto step = static_cast<std::uint32_t>(2 + random() % 50);
                mesh.triangles.push_back({first, (first + 1) % count, (first + step) % count});
            }
        }
        const Mesh expected = sorted_by_comparison(mesh);
        expect_equal(in_canonical_order(mesh), expected);
        EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(expected));
        put_in_canonical_order(mesh);
        expect_equal(mesh, expected);
    }
}

TEST(CanonicalOrder, TakesAttributesAndNormalsAlongInPlace) {
    Mesh mesh = splash(Mode::adaptive);
    const Mesh ordered = in_canonical_order(mesh);
    EXPECT_FALSE(mesh.bricks.empty());
    put_in_canonical_order(mesh);
    expect_equal(mesh, ordered);
    EXPECT_TRUE(mesh.bricks.empty());
    put_in_canonical_order(mesh);
    expect_equal(mesh, ordered);
}

TEST(RoundedNormals, AreThoseOfAMeshThatWasEncodedAndDecoded) {
    if (!test::has_draco()) GTEST_SKIP() << "this build has no Draco";
    for (const bool normals : {true, false}) {
        Mesh mesh = splash(Mode::adaptive, normals);
        mesh.attributes.clear();
        for (const int bits : {0, 2, 3, 5, 8, 11, 16}) {
            std::vector<DecodedBrick> bricks;
            for (std::size_t i = 0; i < mesh.bricks.size(); ++i)
                bricks.push_back(decode_brick(encode_brick(mesh, i, {.normal_bits = bits}), mesh.offset_bits));
            const Mesh decoded = weld_bricks(bricks, mesh.cell_size, mesh.offset_bits);
            Mesh rounded = mesh;
            round_normals(rounded, bits);
            EXPECT_EQ(rounded.normals.empty(), bits == 0 || !normals);
            expect_equal(in_canonical_order(rounded), in_canonical_order(decoded));
        }
    }
}

TEST(RoundedNormals, StayAsTheyAreWhenTheyAreRoundedOnceMore) {
    for (int bits = 2; bits <= 16; ++bits) {
        Mesh mesh = splash(Mode::adaptive);
        round_normals(mesh, bits);
        const Mesh once = mesh;
        round_normals(mesh, bits);
        EXPECT_TRUE(std::equal(once.normals.begin(), once.normals.end(), mesh.normals.begin())) << bits << " bits";
    }
}

TEST(RoundedNormals, AreRefusedForBitsOutOfRange) {
    Mesh mesh;
    for (const int bits : {-1, 1, 17}) EXPECT_THROW(round_normals(mesh, bits), InvalidInput) << bits;
}

}  // namespace
}  // namespace meniscus
