// A brick that is encoded again is the one that its mesh gives in that form.
#include "meniscus/brick_recoding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "meniscus/meniscus.hpp"
#include "support/has_draco.hpp"
#include "support/mesh_attributes.hpp"
#include "support/noise.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

constexpr std::array lattice_profiles{Codec::lattice_packed, Codec::lattice_entropy};

/// Meshes of every input, with attributes.
const std::vector<Mesh>& meshes() {
    static const std::vector<Mesh> all = [] {
        std::vector<test::NamedParticles> inputs = test::adversarial(0.025F);
        inputs.push_back({"splash", test::splash(61, 8)});
        std::vector<Mesh> made;
        for (const auto& [name, particles] : inputs)
            for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
                Settings settings = test::default_settings();
                settings.mode = mode;
                made.push_back(test::reconstruct(settings, particles.frame()));
                test::add_attributes(made.back());
            }
        return made;
    }();
    return all;
}

std::vector<CodedAttribute> all_attributes(const Mesh& mesh, int bits) {
    const std::vector<AttributeWish> all{{.name = {}, .bits = bits}};
    return coded_attributes(mesh, attribute_ranges(mesh), all);
}

EncodedBrick recoded(const Mesh& mesh, std::size_t brick, const CodingOptions& from, const CodingOptions& to) {
    static BrickScratch scratch;
    return recode_brick(encode_brick(mesh, brick, from), mesh.offset_bits, from.attributes, to, scratch);
}

TEST(BrickRecoding, GivesTheBytesOfTheMeshInEitherProfile) {
    for (const Mesh& mesh : meshes())
        for (const Codec from : lattice_profiles)
            for (const Codec to : lattice_profiles) {
                const CodingOptions source{.codec = from, .attributes = all_attributes(mesh, 0)};
                CodingOptions target{.codec = to, .attributes = all_attributes(mesh, 8)};
                std::ranges::reverse(target.attributes);
                target.attributes.pop_back();
                for (std::size_t b = 0; b < mesh.bricks.size(); ++b) {
                    const EncodedBrick brick = recoded(mesh, b, source, target);
                    const EncodedBrick expected = encode_brick(mesh, b, target);
                    ASSERT_EQ(brick.data, expected.data) << name_of(from) << " to " << name_of(to);
                    ASSERT_EQ(brick.coordinate, expected.coordinate);
                    ASSERT_EQ(brick.vertices, expected.vertices);
                    ASSERT_EQ(brick.triangles, expected.triangles);
                    ASSERT_EQ(brick.codec, to);
                }
            }
}

TEST(BrickRecoding, RoundsPositionsAsTheMeshIsRounded) {
    for (const Mesh& mesh : meshes())
        for (const Codec from : lattice_profiles)
            for (const Codec to : lattice_profiles)
                for (std::size_t b = 0; b < mesh.bricks.size(); ++b) {
                    const CodingOptions target{.normal_bits = 0, .position_bits = 3, .codec = to};
                    ASSERT_EQ(recoded(mesh, b, {.codec = from}, target).data, encode_brick(mesh, b, target).data);
                }
}

TEST(BrickRecoding, KeepsTheMeshInDraco) {
    if (!test::has_draco()) GTEST_SKIP();
    for (std::size_t i = 0; i < meshes().size(); ++i) {
        const Mesh& mesh = meshes()[i];
        const Codec from = lattice_profiles[(i / 2) % lattice_profiles.size()];  // each with both modes
        const CodingOptions source{.codec = from, .attributes = all_attributes(mesh, 0)};
        const CodingOptions target{.attributes = source.attributes};
        std::vector<DecodedBrick> bricks;
        std::vector<DecodedBrick> expected;
        for (std::size_t b = 0; b < mesh.bricks.size(); ++b) {
            bricks.push_back(decode_brick(recoded(mesh, b, source, target), mesh.offset_bits, target.attributes));
            expected.push_back(decode_brick(encode_brick(mesh, b, target), mesh.offset_bits, target.attributes));
        }
        ASSERT_EQ(mesh_sha256(weld_bricks(bricks, mesh.cell_size, mesh.offset_bits)), mesh_sha256(mesh));
        const Mesh is = in_canonical_order(weld_bricks(bricks, mesh.cell_size, mesh.offset_bits));
        const Mesh of_mesh = in_canonical_order(weld_bricks(expected, mesh.cell_size, mesh.offset_bits));
        ASSERT_EQ(is.attributes.size(), of_mesh.attributes.size());
        for (std::size_t a = 0; a < is.attributes.size(); ++a)
            ASSERT_TRUE(std::ranges::equal(is.attributes[a].data, of_mesh.attributes[a].data));
    }
}

TEST(BrickRecoding, RefusesWhatTheBrickDoesNotHave) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(61).frame());
    const EncodedBrick brick = encode_brick(mesh, 0, {.codec = Codec::lattice_packed});
    BrickScratch scratch;
    const auto recode = [&](const CodingOptions& options) {
        return recode_brick(brick, mesh.offset_bits, {}, options, scratch);
    };
    EXPECT_THROW(recode({.position_bits = static_cast<int>(mesh.offset_bits) + 1, .codec = Codec::lattice_packed}),
                 InvalidInput);
    EXPECT_THROW(recode({.normal_bits = 1, .codec = Codec::lattice_packed}), InvalidInput);
    EXPECT_THROW(recode({.codec = Codec::lattice_packed, .attributes = {{.name = "velocity"}}}), InvalidInput);
    EncodedBrick draco = brick;
    draco.codec = Codec::draco;
    EXPECT_THROW(recode_brick(draco, mesh.offset_bits, {}, {}, scratch), InvalidInput);
    EXPECT_NO_THROW(recode({.codec = Codec::lattice_entropy})) << "the scratch memory serves on";
}

}  // namespace
}  // namespace meniscus
