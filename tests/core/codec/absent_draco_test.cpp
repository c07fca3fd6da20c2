// A build without Draco: its codec says so, the others are there.
#include <gtest/gtest.h>

#include <string>

#include "meniscus/meniscus.hpp"
#include "support/particles.hpp"
#include "support/refusal.hpp"

namespace meniscus {
namespace {

TEST(WithoutDraco, ItsCodecSaysWhatIsMissingAndWhatServesInstead) {
    const Mesh mesh = test::reconstruct(test::default_settings(), test::splash(62).frame());
    const std::string expected =
        "the codec draco is not in this build of Meniscus, which was made without Draco: take the codecs packed and "
        "entropy, or build it where libdraco-dev 1.5 is installed";
    EXPECT_EQ(test::refusal<NotBuilt>([&] { (void)encode_brick(mesh, 0, {.codec = Codec::draco}); }), expected);
    EncodedBrick brick = encode_brick(mesh, 0, {.codec = Codec::lattice_packed});
    EXPECT_EQ(decode_brick(brick, mesh.offset_bits).triangles.size(), brick.triangles);
    brick.codec = Codec::draco;
    EXPECT_EQ(test::refusal<NotBuilt>([&] { (void)decode_brick(brick, mesh.offset_bits); }), expected);
}

TEST(WithoutDraco, WhatIsWrongWithABrickIsSaidFirst) {
    EncodedBrick brick;
    brick.codec = Codec::draco;
    EXPECT_THROW((void)decode_brick(brick, max_offset_bits + 1), InvalidInput);
}

}  // namespace
}  // namespace meniscus
