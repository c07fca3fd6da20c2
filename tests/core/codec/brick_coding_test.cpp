// Bricks travel through Draco without loss, and decoding survives any bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "codec/round_position.hpp"
#include "meniscus/meniscus.hpp"
#include "support/damaged_bricks.hpp"
#include "support/mesh_check.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

Mesh round_trip(const Mesh& mesh, const CodingOptions& options) {
    std::vector<DecodedBrick> bricks;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        bricks.push_back(decode_brick(encode_brick(mesh, b, options), mesh.offset_bits));
    return weld_bricks(bricks, mesh.cell_size, mesh.offset_bits);
}

TEST(BrickCoding, KeepsPositionsConnectivityLevelsAndJoints) {
    for (const auto& [name, particles] : test::adversarial(0.025F))
        for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
            SCOPED_TRACE(name);
            Settings settings = test::default_settings();
            settings.mode = mode;
            settings.cell_size = 0.4;
            const Mesh mesh = test::reconstruct(settings, particles.frame());
            const Mesh received = round_trip(mesh, {});
            EXPECT_EQ(mesh_sha256(received), mesh_sha256(mesh));
            EXPECT_TRUE(test::check(received).closed_manifold());
            EXPECT_EQ(received.vertices.size(), mesh.vertices.size());
        }
}

TEST(BrickCoding, KeepsEveryNumberOfOffsetBits) {
    for (std::uint32_t steps = 1; steps <= Bisection::max_steps; ++steps) {
        Settings settings = test::default_settings();
        settings.edge_points = Bisection{steps};
        const Mesh mesh = test::reconstruct(settings, test::splash(61, 8).frame());
        EXPECT_EQ(mesh.offset_bits, steps + 1);
        EXPECT_EQ(mesh_sha256(round_trip(mesh, {})), mesh_sha256(mesh));
    }
}

TEST(BrickCoding, KeepsAMeshClosedAndItsLevelsOnEveryCoarserLattice) {
    std::vector<test::NamedParticles> inputs = test::adversarial(0.025F);
    inputs.push_back({"splash", test::splash(61)});
    for (const auto& [name, particles] : inputs)
        for (const EdgePoints& edge_points : {EdgePoints(Interpolation{}), EdgePoints(Bisection{7})}) {
            Settings settings = test::default_settings();
            settings.edge_points = edge_points;
            const Mesh mesh = test::reconstruct(settings, particles.frame());
            for (std::uint32_t bits = 2; bits <= mesh.offset_bits; ++bits) {
                SCOPED_TRACE(name + ", " + std::to_string(bits) + " bits");
                const CodingOptions options{.position_bits = static_cast<int>(bits)};
                EXPECT_EQ(encoded_offset_bits(mesh, options), bits);
                std::vector<DecodedBrick> bricks;
                for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
                    bricks.push_back(decode_brick(encode_brick(mesh, b, options), bits));
                const Mesh coarser = weld_bricks(bricks, mesh.cell_size, bits);
                EXPECT_TRUE(test::check(coarser).closed_manifold()) << test::check(coarser).text();
                EXPECT_EQ(coarser.vertices.size(), mesh.vertices.size());
                for (std::size_t level = 0; level < triangle_level_count; ++level)
                    EXPECT_EQ(coarser.levels[level].count, mesh.levels[level].count);
            }
        }
}

TEST(BrickCoding, RoundsToTheNearestPointInsideOfAVertexsEdge) {
    constexpr std::uint32_t from = 6;
    for (std::uint32_t to = 2; to <= from; ++to)
        for (std::uint32_t p = 0; p <= 64U << from; ++p) {
            const std::uint32_t step = 1U << (from - to);
            const std::uint32_t rounded = round_position(static_cast<std::uint16_t>(p), from, to) * step;
            ASSERT_EQ(rounded % (1U << from) == 0, p % (1U << from) == 0) << p;
            ASSERT_EQ(rounded >> from, p >> from) << p;
            const std::uint32_t moved = std::max(p, rounded) - std::min(p, rounded);
            // By half a step; beside a lattice point, which stays free, by less than one.
            const std::uint32_t beside = p % (1U << from);
            ASSERT_LE(2 * moved, beside < step || beside > (1U << from) - step ? 2 * step - 1 : step) << p;
        }
}

TEST(BrickCoding, HashesTheSameContentAlikeAndAnyOtherDifferently) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    const BrickContent content = brick_content(mesh, 0);
    EXPECT_EQ(content.hash(), brick_content(mesh, 0).hash());
    const auto differs = [&](const auto& change) {
        BrickContent other = content;
        change(other);
        EXPECT_NE(other.hash(), content.hash());
    };
    differs([](BrickContent& c) { c.positions.back()[2] ^= 1U; });
    differs([](BrickContent& c) { c.normals.front()[0] = -c.normals.front()[0]; });
    differs([](BrickContent& c) { std::swap(c.triangles[0], c.triangles[1]); });
    differs([](BrickContent& c) { c.cell_levels.back() ^= std::byte{1}; });
    differs([](BrickContent& c) { c.normals.clear(); });
    differs([](BrickContent& c) { c.triangles.pop_back(); });
}

TEST(BrickCoding, RefusesALatticeFinerThanTheMeshs) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    EXPECT_THROW(brick_content(mesh, 0, {.position_bits = 1}), InvalidInput);
    EXPECT_THROW(brick_content(mesh, 0, {.position_bits = 7}), InvalidInput);
}

TEST(BrickCoding, KeepsNormalsWithinTwoDegreesAtEightBits) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    const Mesh received = round_trip(mesh, {});
    std::vector<std::pair<LatticePosition, Normal>> before, after;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) before.emplace_back(mesh.vertices[v], mesh.normals[v]);
    for (std::size_t v = 0; v < received.vertices.size(); ++v)
        after.emplace_back(received.vertices[v], received.normals[v]);
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    ASSERT_EQ(before.size(), after.size());
    const double least = std::cos(2.0 * 3.14159265358979 / 180.0);
    for (std::size_t v = 0; v < before.size(); ++v) {
        const auto& [p, n] = before[v];
        const auto& [q, m] = after[v];
        ASSERT_EQ(p, q);
        EXPECT_GE(n[0] * m[0] + n[1] * m[1] + n[2] * m[2], least);
    }
    EXPECT_TRUE(round_trip(mesh, {.normal_bits = 0}).normals.empty());
}

TEST(BrickCoding, SendsAMeshWithoutNormals) {
    Settings settings = test::default_settings();
    const auto particles = test::splash(62);
    const Mesh with = test::reconstruct(settings, particles.frame());
    settings.normals = false;
    const Mesh without = test::reconstruct(settings, particles.frame());
    EXPECT_FALSE(with.normals.empty());
    EXPECT_TRUE(without.normals.empty());
    EXPECT_EQ(mesh_sha256(without), mesh_sha256(with));
    const Mesh received = round_trip(without, {.normal_bits = 8});
    EXPECT_TRUE(received.normals.empty());
    EXPECT_EQ(mesh_sha256(received), mesh_sha256(with));
}

TEST(BrickCoding, RefusesADamagedBrickOrDecodesSomeMesh) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(63, 6).frame());
    const EncodedBrick whole = encode_brick(mesh, 0);
    int refused = 0;
    for (const EncodedBrick& damaged : test::damaged(whole, 2000)) {
        try {
            const DecodedBrick decoded = decode_brick(damaged, mesh.offset_bits);
            for (const Triangle& t : decoded.triangles)
                for (const std::uint32_t v : t) ASSERT_LT(v, decoded.vertices.size());
        } catch (const InvalidInput&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 20);
    EncodedBrick lying = whole;
    lying.triangles += 1;
    EXPECT_THROW(decode_brick(lying, mesh.offset_bits), InvalidInput);
    lying = whole;
    lying.cell_levels.push_back(std::byte{1});
    EXPECT_THROW(decode_brick(lying, mesh.offset_bits), InvalidInput);
    lying = whole;
    lying.coordinate = {2'000'000'000, 0, 0};
    EXPECT_THROW(decode_brick(lying, mesh.offset_bits), InvalidInput);
    EXPECT_THROW(decode_brick(whole, 40), InvalidInput);
    EXPECT_THROW(decode_brick(whole, min_offset_bits - 1), InvalidInput);
    EXPECT_THROW(decode_brick(whole, max_offset_bits + 1), InvalidInput);
}

/// The Draco bytes of a brick, with other counts in their header.
EncodedBrick with_counts(EncodedBrick brick, std::uint32_t vertices, std::uint32_t faces, std::uint32_t symbols) {
    constexpr std::size_t counts_at = 12;
    std::vector<std::byte> draco(brick.data.begin(), brick.data.begin() + counts_at);
    std::size_t rest = counts_at;
    const auto replace = [&](std::uint32_t value) {
        while (std::to_integer<unsigned>(brick.data.at(rest++)) >= 0x80U) {
        }
        for (; value >= 0x80U; value >>= 7) draco.push_back(static_cast<std::byte>((value & 0x7FU) | 0x80U));
        draco.push_back(static_cast<std::byte>(value));
    };
    replace(vertices);
    replace(faces);
    draco.push_back(brick.data.at(rest++));
    replace(symbols);
    draco.insert(draco.end(), brick.data.begin() + static_cast<std::ptrdiff_t>(rest), brick.data.end());
    brick.data = draco;
    return brick;
}

TEST(BrickCoding, RefusesCountsBeforeDracoAllocatesByThem) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(63, 6).frame());
    const EncodedBrick whole = encode_brick(mesh, 0);
    const auto refusal = [&](const EncodedBrick& brick) -> std::string {
        try {
            decode_brick(brick, mesh.offset_bits);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(refusal(whole), "");
    // Draco would ask for 30 GB.
    constexpr std::uint32_t many = 1'000'000'000;
    EXPECT_NE(refusal(with_counts(whole, many / 2, many, many)).find("has 1000000000 triangles, announced were"),
              std::string::npos);
    EXPECT_NE(refusal(with_counts(whole, many, whole.triangles, whole.triangles)).find("1000000000 vertices"),
              std::string::npos);
    EXPECT_NE(refusal(with_counts(whole, whole.vertices, whole.triangles, many)).find("1000000000 symbols"),
              std::string::npos);
    EncodedBrick announced = with_counts(whole, 2'000'000, 4'000'000, 4'000'000);
    announced.triangles = 4'000'000;
    EXPECT_NE(refusal(announced).find("more than 64 per byte"), std::string::npos);
}

TEST(BrickCoding, RefusesACodecThatItDoesNotKnowWithItsNumber) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(63, 6).frame());
    EncodedBrick brick = encode_brick(mesh, 0);
    EXPECT_EQ(brick.codec, Codec::draco);
    brick.codec = static_cast<Codec>(7);
    const auto refusal = [](const auto& attempt) -> std::string {
        try {
            attempt();
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_NE(refusal([&] {
                  decode_brick(brick, mesh.offset_bits);
              }).find("has the codec 7, which this version does not know; it knows 3 (entropy), 2 (packed), 1 (draco)"),
              std::string::npos);
    EXPECT_NE(refusal([&] { encode_brick(mesh, 0, {.codec = static_cast<Codec>(7)}); }).find("codec is 7"),
              std::string::npos);
}

TEST(BrickCoding, RefusesABrickThatOccursTwice) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(64, 6).frame());
    const DecodedBrick brick = decode_brick(encode_brick(mesh, 0), mesh.offset_bits);
    EXPECT_THROW(weld_bricks(std::vector{brick, brick}, mesh.cell_size, mesh.offset_bits), InvalidInput);
}

}  // namespace
}  // namespace meniscus
