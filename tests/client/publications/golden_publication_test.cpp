// A publication that the first build with publications wrote: two frames of five particles, with an attribute.
#include <gtest/gtest.h>

#include <filesystem>

#include "meniscus/client/publication.hpp"
#include "meniscus/mesh_hash.hpp"

namespace meniscus::test {
namespace {

TEST(GoldenFiles, APublicationOfVersion1IsRead) {
    client::Publication publication(std::filesystem::path(MENISCUS_GOLDEN_FILES) / "version_1_publication");
    const client::PublicationInfo& info = publication.info();
    EXPECT_EQ(info.description.name, "five");
    ASSERT_TRUE(info.settings);
    EXPECT_EQ(info.settings->particle_radius, 0.125);
    ASSERT_EQ(info.attributes.size(), 1U);
    EXPECT_EQ(info.attributes[0].name, "age");
    ASSERT_EQ(info.frames, 2U);
    EXPECT_EQ(info.segments.size(), 1U);
    EXPECT_EQ(publication.frame(0).index, 3U);
    EXPECT_EQ(publication.frame(1).simulation_time, 0.16);
    EXPECT_EQ(mesh_sha256(publication.frame(0).mesh()),
              "1df28ea1db8a115938ac265c4447eac0930a42470e058ca7f154726515becb0d");
    EXPECT_EQ(mesh_sha256(publication.frame(1).mesh()),
              "313e7d57e62c0d4f24ca1eb9aff2126683648539c39be41a8ca4c6ae8378333c");
    EXPECT_EQ(publication.frame(1).mesh().attributes.at(0).name, "age");
}

}  // namespace
}  // namespace meniscus::test
