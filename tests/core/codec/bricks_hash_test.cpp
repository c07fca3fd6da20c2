// bricks_sha256: a sum over bricks, in any order, however these are shared out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/sha256.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

Mesh surface() {
    Mesh mesh;
    Reconstructor(test::default_settings(), {Backend::cpu, 1}).reconstruct(test::splash(61).frame(), mesh);
    return mesh;
}

/// Hexadecimal digits, the highest first: the sum modulo 16^64.
std::string sum(const std::string& a, const std::string& b) {
    std::string out(a.size(), '0');
    int carry = 0;
    const auto value = [](char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; };
    for (std::size_t i = a.size(); i-- > 0; carry /= 16) {
        carry += value(a[i]) + value(b[i]);
        out[i] = "0123456789abcdef"[carry % 16];
    }
    return out;
}

/// The definition, written down anew: texts in place of numbers, a set of them in place of arrays.
std::string by_definition(const Mesh& mesh) {
    std::string total(64, '0');
    for (const MeshBrick& brick : mesh.bricks) {
        const auto bytes_of = [](const auto& value) {
            return std::string(reinterpret_cast<const char*>(&value), sizeof value);
        };
        std::vector<std::pair<int, std::vector<std::int32_t>>> triangles;
        for (const auto& [level, byte] : {std::pair{3U, 0}, {0U, 1}, {1U, 2}, {2U, 3}}) {
            const TriangleRange& range = brick.ranges[level];
            for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
                std::vector<std::int32_t> least;
                for (std::size_t turn = 0; turn < 3; ++turn) {
                    std::vector<std::int32_t> numbers;
                    for (std::size_t corner = 0; corner < 3; ++corner)
                        for (const std::int32_t x : mesh.vertices[mesh.triangles[t][(corner + turn) % 3]])
                            numbers.push_back(x);
                    if (least.empty() || numbers < least) least = numbers;
                }
                triangles.emplace_back(byte, least);
            }
        }
        std::sort(triangles.begin(), triangles.end());
        std::string content = bytes_of(mesh.cell_size) + bytes_of(mesh.offset_bits) + bytes_of(brick.coordinate) +
                              bytes_of(std::uint64_t{triangles.size()});
        for (const auto& [byte, numbers] : triangles) {
            content += static_cast<char>(byte);
            for (const std::int32_t x : numbers) content += bytes_of(x);
        }
        total = sum(total, sha256_of(content));
    }
    return total;
}

/// The mesh of some of its bricks, with vertices that none uses.
Mesh part(const Mesh& mesh, std::size_t first, std::size_t step) {
    Mesh out = mesh;
    out.bricks.clear();
    for (std::size_t b = first; b < mesh.bricks.size(); b += step) out.bricks.push_back(mesh.bricks[b]);
    return out;
}

TEST(BricksSha256, IsThatOfItsDefinition) {
    const Mesh mesh = surface();
    ASSERT_GT(mesh.bricks.size(), 4U);
    EXPECT_EQ(bricks_sha256(mesh), by_definition(mesh));
}

/// Computed by Python: hashlib and integers.
TEST(BricksSha256, HasAKnownAnswer) {
    Mesh mesh;
    mesh.cell_size = 0.5;
    mesh.offset_bits = 6;
    for (const LatticePosition& p : {LatticePosition{0, 0, 0}, {64, 0, 0}, {0, 64, 0}, {0, 0, -64}})
        mesh.vertices.push_back(p);
    mesh.triangles.push_back({1, 2, 0});
    mesh.triangles.push_back({2, 3, 0});
    mesh.bricks.resize(2);
    mesh.bricks[0].coordinate = {0, 0, -1};
    mesh.bricks[0].ranges[0] = {1, 1};
    mesh.bricks[1].coordinate = {0, 0, 0};
    mesh.bricks[1].ranges[3] = {0, 1};
    EXPECT_EQ(bricks_sha256(mesh), "f5006eba842c4bc3ef7242f5e0e7e9741cd970ef95fec41450990efe9cabcc1e");
    EXPECT_EQ(bricks_sha256(Mesh{}), std::string(64, '0'));
}

TEST(BricksSha256, DependsOnNoOrder) {
    const Mesh mesh = surface();
    const std::string expected = bricks_sha256(mesh);
    std::mt19937 random(1);
    for (int i = 0; i < 3; ++i) {
        Mesh other = mesh;
        std::shuffle(other.bricks.begin(), other.bricks.end(), random);
        std::vector<std::uint32_t> place(mesh.vertices.size());
        std::iota(place.begin(), place.end(), 0U);
        std::shuffle(place.begin(), place.end(), random);
        for (std::size_t v = 0; v < place.size(); ++v) other.vertices[place[v]] = mesh.vertices[v];
        for (Triangle& t : other.triangles) {
            for (std::uint32_t& v : t) v = place[v];
            std::rotate(t.begin(), t.begin() + random() % 3, t.end());
        }
        for (const MeshBrick& brick : other.bricks)
            for (const TriangleRange& range : brick.ranges)
                std::shuffle(other.triangles.begin() + range.first, other.triangles.begin() + range.first + range.count,
                             random);
        EXPECT_EQ(bricks_sha256(other), expected);
    }
}

TEST(BricksSha256, IsTheSumOfThoseOfAnyParts) {
    const Mesh mesh = surface();
    const std::string expected = bricks_sha256(mesh);
    for (const std::size_t parts : {1U, 2U, 3U, 7U}) {
        std::string total(64, '0');
        for (std::size_t p = 0; p < parts; ++p) total = sum(total, bricks_sha256(part(mesh, p, parts)));
        EXPECT_EQ(total, expected) << parts;
    }
}

TEST(BricksSha256, ChangesWithAnyVertexLevelOrPlace) {
    const Mesh mesh = surface();
    const std::string before = bricks_sha256(mesh);
    Mesh moved = mesh;
    ++moved.vertices[moved.triangles.back()[0]][1];
    EXPECT_NE(bricks_sha256(moved), before);
    Mesh elsewhere = mesh;
    ++elsewhere.bricks.front().coordinate[2];
    EXPECT_NE(bricks_sha256(elsewhere), before);
    Mesh other_level = mesh;
    std::swap(other_level.bricks.front().ranges[1], other_level.bricks.front().ranges[2]);
    EXPECT_NE(bricks_sha256(other_level), before);
    Mesh other_scale = mesh;
    other_scale.cell_size *= 2.0;
    EXPECT_NE(bricks_sha256(other_scale), before);
}

TEST(BricksSha256, IsThatOfTheMeshAfterItsWayThroughAnyCodec) {
    for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy}) {
        Reconstructor reconstructor(test::default_settings(),
                                    {.backend = Backend::cpu, .threads = 1, .keep_lattice = true});
        Mesh mesh;
        reconstructor.reconstruct(test::splash(61).frame(), mesh);
        std::vector<DecodedBrick> bricks;
        for (std::size_t b = mesh.bricks.size(); b-- > 0;)
            bricks.push_back(decode_brick(encode_brick(mesh, b, {.codec = codec}), mesh.offset_bits));
        EXPECT_EQ(bricks_sha256(weld_bricks(bricks, mesh.cell_size, mesh.offset_bits)), bricks_sha256(mesh));
    }
}

TEST(BricksSha256, RefusesAMeshWithoutBricks) {
    const Mesh mesh = in_canonical_order(surface());
    EXPECT_THROW(bricks_sha256(mesh), InvalidInput);
}

}  // namespace
}  // namespace meniscus
