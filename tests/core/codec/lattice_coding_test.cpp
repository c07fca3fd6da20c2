// Bricks travel by their lattice without loss, in both profiles, and decoding survives any bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/damaged_bricks.hpp"
#include "support/has_draco.hpp"
#include "support/mesh_attributes.hpp"
#include "support/noise.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

constexpr std::array lattice_codecs{Codec::lattice_packed, Codec::lattice_entropy};

CodingOptions with(Codec codec, CodingOptions options = {}) {
    options.codec = codec;
    return options;
}

std::vector<DecodedBrick> decoded(const Mesh& mesh, const CodingOptions& options) {
    std::vector<DecodedBrick> bricks;
    for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
        bricks.push_back(
            decode_brick(encode_brick(mesh, b, options), encoded_offset_bits(mesh, options), options.attributes));
    return bricks;
}

Mesh round_trip(const Mesh& mesh, const CodingOptions& options) {
    return weld_bricks(decoded(mesh, options), mesh.cell_size, encoded_offset_bits(mesh, options));
}

void expect_kept(const Mesh& mesh, const CodingOptions& options = {}) {
    for (const Codec codec : lattice_codecs)
        ASSERT_EQ(mesh_sha256(round_trip(mesh, with(codec, options))), mesh_sha256(mesh)) << name_of(codec);
}

/// The vertices of bricks with all that belongs to them, in an order that does not depend on the codec.
using Vertex = std::tuple<LatticePosition, Normal, std::vector<std::byte>>;
std::vector<Vertex> vertices_of(const std::vector<DecodedBrick>& bricks) {
    std::vector<Vertex> vertices;
    for (const DecodedBrick& brick : bricks)
        for (std::size_t v = 0; v < brick.vertices.size(); ++v) {
            std::vector<std::byte> values;
            for (const MeshAttribute& attribute : brick.attributes) {
                const std::byte* const value = attribute.data.data() + v * attribute.element_bytes();
                values.insert(values.end(), value, value + attribute.element_bytes());
            }
            vertices.emplace_back(brick.vertices[v], brick.normals.empty() ? Normal{} : brick.normals[v], values);
        }
    std::ranges::sort(vertices);
    return vertices;
}

TEST(LatticeCoding, KeepsTheMeshOfEveryInput) {
    std::vector<test::NamedParticles> inputs = test::adversarial(0.025F);
    inputs.push_back({"splash", test::splash(61)});
    for (const auto& [name, particles] : inputs)
        for (const Mode mode : {Mode::adaptive, Mode::uniform})
            for (const Field field : {Field::smooth, Field::color, Field::density}) {
                SCOPED_TRACE(name);
                Settings settings = test::default_settings();
                settings.mode = mode;
                settings.field = field;
                settings.cell_size = 0.4;
                expect_kept(test::reconstruct(settings, particles.frame()));
            }
}

TEST(LatticeCoding, KeepsTheMeshOfThePaper) {
    expect_kept(test::reconstruct(preset(Preset::paper, 0.025), test::splash(63).frame()));
}

TEST(LatticeCoding, KeepsEveryNumberOfOffsetBits) {
    for (std::uint32_t steps = 1; steps <= Bisection::max_steps; ++steps) {
        Settings settings = test::default_settings();
        settings.edge_points = Bisection{steps};
        const Mesh mesh = test::reconstruct(settings, test::splash(61, 8).frame());
        EXPECT_EQ(mesh.offset_bits, steps + 1);
        expect_kept(mesh);
    }
}

TEST(LatticeCoding, KeepsAMeshThatADomainCrops) {
    Settings settings = test::default_settings();
    settings.domain = Box{{-0.1, -0.1, -0.1}, {0.13, 0.31, 0.17}};
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        settings.mode = mode;
        const Mesh mesh = test::reconstruct(settings, test::splash(64).frame());
        ASSERT_FALSE(mesh.triangles.empty());
        expect_kept(mesh);
    }
}

TEST(LatticeCoding, KeepsCappedLevels) {
    BackendOptions options{.backend = Backend::cpu};
    options.keep_lattice = true;
    Reconstructor reconstructor(test::default_settings(), options);
    const test::Particles particles = test::splash(65);
    Mesh mesh;
    reconstructor.reconstruct(particles.frame(), mesh);
    for (const int max_level : {2, 1}) {
        Mesh capped;
        reconstructor.emit_capped(max_level, capped);
        expect_kept(capped);
    }
}

void expect_noise_kept(const test::NoiseWorld& world, std::uint64_t first, std::uint64_t count) {
    test::for_each_seed(world, first, test::noise_worlds(count), [](const test::NoiseWorld& seeded) {
        SCOPED_TRACE(seeded.seed);
        expect_kept(test::mesh_of_noise_on_cpu(seeded));
    });
}

// The worlds lie across eight bricks: all kinds of cells meet at the bricks' faces, too.
TEST(LatticeCoding, KeepsWhiteNoiseOverRandomLevels) {
    expect_noise_kept({.first = 14, .keeps_slivers = true}, 11, 100);
}
TEST(LatticeCoding, KeepsWhiteNoiseWhereSliversAreRaised) {
    expect_noise_kept({.first = 13, .keeps_slivers = false}, 7011, 50);
}
TEST(LatticeCoding, KeepsWhiteNoiseWhereFewPointsAreInside) {
    expect_noise_kept({.first = 14, .share = 0.05}, 1011, 50);
}
TEST(LatticeCoding, KeepsWhiteNoiseWhenTheBandMustGrow) {
    expect_noise_kept({.first = 14, .share = 0.02, .band_share = 0.1}, 4011, 50);
}
TEST(LatticeCoding, KeepsWhiteNoiseWhereLevelsAreCapped) {
    for (const int max_level : {1, 2}) expect_noise_kept({.first = 14, .max_level = max_level}, 8011, 50);
}
TEST(LatticeCoding, KeepsWhiteNoiseInUniformMode) {
    expect_noise_kept({.first = 15, .side = 3, .uniform = true}, 5011, 20);
}

TEST(LatticeCoding, RoundsPositionsAndNormalsAsDracoDoes) {
    if (!test::has_draco()) GTEST_SKIP() << "this build has no Draco";
    for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
        Settings settings = test::default_settings();
        settings.mode = mode;
        settings.edge_points = Bisection{7};
        const Mesh mesh = test::reconstruct(settings, test::splash(66).frame());
        for (const CodingOptions& options :
             {CodingOptions{.normal_bits = 2, .position_bits = 2}, CodingOptions{.normal_bits = 5, .position_bits = 4},
              CodingOptions{.normal_bits = 8}, CodingOptions{.normal_bits = 10, .position_bits = 7},
              CodingOptions{.normal_bits = 16, .position_bits = 6}}) {
            const auto by_draco = vertices_of(decoded(mesh, options));
            for (const Codec codec : lattice_codecs)
                EXPECT_EQ(vertices_of(decoded(mesh, with(codec, options))), by_draco)
                    << name_of(codec) << ' ' << options.normal_bits;
        }
    }
}

TEST(LatticeCoding, KeepsAttributesAsDracoDoes) {
    if (!test::has_draco()) GTEST_SKIP() << "this build has no Draco";
    Mesh mesh = test::reconstruct(test::default_settings(), test::splash(67).frame());
    test::add_attributes(mesh);
    for (const int bits : {0, 5, 12}) {
        const AttributeWish all{"", bits};
        CodingOptions options;
        options.attributes = coded_attributes(mesh, attribute_ranges(mesh), {&all, 1});
        ASSERT_FALSE(options.attributes.empty());
        const auto by_draco = vertices_of(decoded(mesh, options));
        for (const Codec codec : lattice_codecs) EXPECT_EQ(vertices_of(decoded(mesh, with(codec, options))), by_draco);
    }
}

TEST(LatticeCoding, IsEncodedAgainByDracoWithoutLoss) {
    if (!test::has_draco()) GTEST_SKIP() << "this build has no Draco";
    Mesh mesh = test::reconstruct(test::default_settings(), test::splash(67).frame());
    test::add_attributes(mesh);
    const AttributeWish all{"", 9};
    CodingOptions options;
    options.attributes = coded_attributes(mesh, attribute_ranges(mesh), {&all, 1});
    std::vector<DecodedBrick> again;
    for (const DecodedBrick& brick : decoded(mesh, with(Codec::lattice_entropy, options)))
        again.push_back(
            decode_brick(encode_brick(brick, mesh.offset_bits, options), mesh.offset_bits, options.attributes));
    EXPECT_EQ(vertices_of(again), vertices_of(decoded(mesh, options)));
    EXPECT_EQ(mesh_sha256(weld_bricks(again, mesh.cell_size, mesh.offset_bits)), mesh_sha256(mesh));
}

TEST(LatticeCoding, HashesTheSameContentAlikeAndAnyOtherDifferently) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    BrickScratch scratch;
    const auto hash = [&](const Mesh& of, const CodingOptions& options) {
        return PreparedBrick(of, 0, options, scratch).hash();
    };
    const CodingOptions packed = with(Codec::lattice_packed);
    // A brick is its content, not its codec's bytes.
    EXPECT_EQ(hash(mesh, packed), hash(mesh, with(Codec::lattice_entropy)));
    EXPECT_NE(hash(mesh, packed), hash(mesh, with(Codec::lattice_packed, {.normal_bits = 9})));
    EXPECT_NE(hash(mesh, packed), hash(mesh, with(Codec::lattice_packed, {.normal_bits = 0})));
    EXPECT_NE(hash(mesh, packed), hash(mesh, with(Codec::lattice_packed, {.position_bits = 5})));
    const auto differs = [&](const auto& change) {
        Mesh other = mesh;
        change(other);
        EXPECT_NE(hash(other, packed), hash(mesh, packed));
    };
    const LatticeBlock* const first = mesh.lattice.blocks.data() + mesh.lattice.bricks[0].first;
    const LatticeBlock* crossed = first;
    while (crossed->edges[0] == 0) ++crossed;
    differs([&](Mesh& m) {
        std::int32_t& x = m.vertices[crossed->first_vertex][0];
        x += (x & 63) == 63 ? -1 : 1;
    });
    // Of a mesh whose offsets are 1, nothing but the lattice is another with fewer bits.
    Mesh lowest = mesh;
    for (LatticePosition& vertex : lowest.vertices)
        for (std::int32_t& coordinate : vertex)
            if ((coordinate & 63) != 0) coordinate = (coordinate & ~63) + 1;
    EXPECT_NE(hash(lowest, with(Codec::lattice_packed, {.normal_bits = 0, .position_bits = 5})),
              hash(lowest, with(Codec::lattice_packed, {.normal_bits = 0, .position_bits = 4})));
    differs([&](Mesh& m) {
        Normal& normal = m.normals[crossed->first_vertex];
        for (float& component : normal) component = -component;
    });
}

TEST(LatticeCoding, HasTheSameHashWhereABrickOnlyTouchesAnotherLevel) {
    std::size_t touched = 0;
    test::for_each_seed({.first = 14}, 21, 10, [&](const test::NoiseWorld& seeded) {
        const Mesh mesh = test::mesh_of_noise_on_cpu(seeded);
        Mesh other = mesh;
        BrickScratch scratch;
        for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
            for (std::uint32_t i = 0; i < mesh.lattice.bricks[b].count; ++i) {
                std::uint8_t& coarser = other.lattice.blocks[mesh.lattice.bricks[b].first + i].coarser;
                for (int face = 0; face < 6; ++face) {
                    const std::uint8_t before = coarser;
                    coarser = static_cast<std::uint8_t>(coarser ^ 1 << face);
                    const auto brick_of = [&](const Mesh& m) {
                        const CodingOptions options = with(Codec::lattice_packed);
                        const PreparedBrick brick(m, b, options, scratch);
                        return std::pair(brick.hash(), brick.encode().data);
                    };
                    const auto [hash, data] = brick_of(mesh);
                    const auto [other_hash, other_data] = brick_of(other);
                    ASSERT_EQ(hash == other_hash, data == other_data);
                    if (data == other_data) ++touched;
                    coarser = before;
                }
                if (i > 40) break;
            }
    });
    EXPECT_GT(touched, 1000U);
}

TEST(LatticeCoding, GivesTheSameBytesWhateverWasCodedBefore) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(68).frame());
    for (const Codec codec : lattice_codecs) {
        BrickScratch used;
        for (std::size_t b = 0; b < mesh.bricks.size(); ++b) {
            const EncodedBrick again = PreparedBrick(mesh, b, with(codec), used).encode();
            BrickScratch fresh;
            EXPECT_EQ(again.data, PreparedBrick(mesh, b, with(codec), fresh).encode().data);
            for (const EncodedBrick& brick : test::damaged(again, 3)) try {
                    (void)decode_brick(brick, mesh.offset_bits);
                } catch (const InvalidInput&) {
                }
            const DecodedBrick after_damage = decode_brick(again, mesh.offset_bits);
            EXPECT_EQ(after_damage.triangles.size(), again.triangles);
        }
    }
}

TEST(LatticeCoding, RefusesAMeshWithoutItsLattice) {
    Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    mesh.lattice = {};
    try {
        (void)encode_brick(mesh, 0, with(Codec::lattice_packed));
        FAIL() << "encoded";
    } catch (const InvalidInput& refusal) {
        EXPECT_NE(std::string(refusal.what()).find("has no lattice"), std::string::npos) << refusal.what();
    }
}

TEST(LatticeCoding, RefusesOrDecodesDamagedBricks) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(69).frame());
    for (const Codec codec : lattice_codecs) {
        std::size_t refused = 0;
        std::size_t tried = 0;
        for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
            for (const EncodedBrick& brick : test::damaged(encode_brick(mesh, b, with(codec)), 200)) {
                ++tried;
                try {
                    const DecodedBrick got = decode_brick(brick, mesh.offset_bits);
                    ASSERT_EQ(got.vertices.size(), brick.vertices);
                    ASSERT_EQ(got.triangles.size(), brick.triangles);
                    for (const Triangle& triangle : got.triangles)
                        for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, got.vertices.size());
                } catch (const InvalidInput&) {
                    ++refused;
                }
            }
        EXPECT_GT(refused, tried / 10) << name_of(codec);
    }
}

TEST(LatticeCoding, RefusesWrongCountsBitsVersionsAndEnds) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(69).frame());
    for (const Codec codec : lattice_codecs) {
        const EncodedBrick whole = encode_brick(mesh, 0, with(codec));
        const auto refusal = [&](const auto& change) -> std::string {
            EncodedBrick brick = whole;
            change(brick);
            try {
                (void)decode_brick(brick, mesh.offset_bits);
            } catch (const InvalidInput& error) {
                return error.what();
            }
            return "";
        };
        EXPECT_EQ(refusal([](EncodedBrick&) {}), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { ++b.vertices; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { --b.vertices; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { ++b.triangles; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { --b.triangles; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.vertices = b.triangles = 0xFFFFFFFFU; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data.clear(); }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data[0] ^= std::byte{2}; }), "");     // the version
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data[0] |= std::byte{0x80}; }), "");  // flags kept for later
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data[0] |= std::byte{0x20}; }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) {
                      b.codec = b.codec == Codec::lattice_packed ? Codec::lattice_entropy : Codec::lattice_packed;
                  }),
                  "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.cell_levels.push_back({}); }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data[1] ^= std::byte{1}; }), "");  // offset bits
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data.resize(b.data.size() + 2); }), "");
        EXPECT_NE(refusal([](EncodedBrick& b) { b.data.resize(b.data.size() / 2); }), "");
    }
}

}  // namespace
}  // namespace meniscus
