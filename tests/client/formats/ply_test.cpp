#include <gtest/gtest.h>

#include <bit>

#include "formats/bytes/scalar.hpp"
#include "formats/meshes/point_writer.hpp"
#include "formats/particles/particle_file.hpp"
#include "formats/particles/particle_readers.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

using formats::read_particle_ply;
using formats::store;

/// Two particles with levels 1 and 2 among properties that are not ours.
std::string particle_ply(std::endian order) {
    std::string out =
        order == std::endian::big ? "ply\nformat binary_big_endian 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
    out +=
        "obj_info none\nelement vertex 2\nproperty double x\nproperty float y\nproperty double z\nproperty list uchar "
        "short more\n"
        "property int level\nend_header\n";
    for (int i = 0; i < 2; ++i) {
        store(out, 1.0 + 3 * i, order);
        store(out, static_cast<float>(2 + 3 * i), order);
        store(out, 3.0 + 3 * i, order);
        out += char{2};
        store(out, std::int16_t{-1}, order);
        store(out, std::int16_t{-1}, order);
        store(out, std::int32_t{1 + i}, order);
    }
    return out;
}

TEST(ParticlePlyReader, ReadsBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const auto particles = read_particle_ply("f", particle_ply(order));
        EXPECT_EQ(particles.positions, (std::vector<float>{1, 2, 3, 4, 5, 6}));
        EXPECT_EQ(particles.levels, (std::vector<std::uint8_t>{1, 2}));
    }
}

TEST(ParticlePlyReader, ReadsThePointsThatTheWriterWrites) {
    const TemporaryDirectory directory;
    formats::write_points(directory / "points.ply", std::vector<Point>{{1.0F, -2.5F, 3e7F}, {0.1F, 0.0F, -0.0F}});
    EXPECT_EQ(formats::read_particles(directory / "points.ply").positions,
              (std::vector<float>{1.0F, -2.5F, 3e7F, 0.1F, 0.0F, -0.0F}));
    formats::write_points(directory / "none.ply", {});
    EXPECT_EQ(formats::read_particles(directory / "none.ply").count(), 0U);
}

TEST(ParticlePlyReader, ReadsAscii) {
    const auto particles =
        read_particle_ply("f",
                          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float z\nproperty float x\n"
                          "property float y\nend_header\n3 1 2\n6 4 5");
    EXPECT_EQ(particles.positions, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_TRUE(particles.levels.empty());
}

TEST(ParticlePlyReader, RefusesBytesAfterTheLastElement) {
    const std::string message = refusal([] { read_particle_ply("f", particle_ply(std::endian::little) + "abc"); });
    EXPECT_NE(message.find("3 bytes follow"), std::string::npos) << message;
}

TEST(ParticlePlyReader, RefusesACountBeyondTheFile) {
    std::string text = particle_ply(std::endian::little);
    text.replace(text.find("vertex 2"), 8, "vertex 9999999999");
    const std::string message = refusal([&] { read_particle_ply("f", text); });
    EXPECT_NE(message.find("9999999999 vertex rows"), std::string::npos) << message;
}

TEST(ParticlePlyReader, RefusesAListBeyondTheFile) {
    EXPECT_NE(refusal([] {
                  read_particle_ply(
                      "f",
                      "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uint int a\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n4000000000 1 2 3");
              }).find("bytes follow"),
              std::string::npos);
}

TEST(ParticlePlyReader, RefusesFilesWithoutCoordinates) {
    EXPECT_NE(refusal([] {
                  read_particle_ply("f", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n");
              }),
              "");
    EXPECT_NE(refusal([] { read_particle_ply("f", "ply\nformat ascii 1.0\nend_header\n"); }), "");
    EXPECT_NE(
        refusal([] { read_particle_ply("f", "ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n"); }), "");
}

TEST(ParticlePlyReader, CountsTheFacesOfAMesh) {
    EXPECT_EQ(read_particle_ply("f", particle_ply(std::endian::little)).faces, 0U);
    const auto mesh = read_particle_ply("f",
                                        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                        "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                                        "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n");
    EXPECT_EQ(mesh.count(), 3U);
    EXPECT_EQ(mesh.faces, 2U);
}

}  // namespace
}  // namespace meniscus::test
