// Recordings and files of bricks that earlier builds wrote: one of each version, which is read, or refused with a line
// that says so. All hold five particles; version 2 was written by the first build that knew it, and again by the first
// that gave recordings checksums.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/meshes/mesh_file.hpp"
#include "formats/recordings/brick_file.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/reconstructor.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

const std::filesystem::path folder = MENISCUS_GOLDEN_FILES;
constexpr std::size_t triangles = 116;

TEST(GoldenFiles, OfVersion1AreRefusedInALineThatNamesBothVersions) {
    const auto recording = folder / "version_1.recording";
    EXPECT_EQ(refusal([&] { formats::Recording{recording}; }),
              recording.string() +
                  ": a recording of format version 1; this program reads version 2: read it with the "
                  "Meniscus that wrote it");
    const auto bricks = folder / "version_1.bricks";
    EXPECT_EQ(refusal([&] { formats::read_mesh(bricks); }),
              bricks.string() +
                  ": a file of bricks of format version 1; this program reads version 2: read it with the "
                  "Meniscus that wrote it");
}

void expect_golden_frames(const std::filesystem::path& path) {
    const formats::Recording recording(path);
    EXPECT_EQ(recording.cut_bytes(), 0U);
    EXPECT_EQ(recording.settings().particle_radius, 0.125);
    ASSERT_EQ(recording.frames().size(), 2U);
    for (std::uint64_t i = 0; i < 2; ++i) {
        const formats::RecordedFrame& frame = recording.frames()[i];
        EXPECT_EQ(frame.index, i);
        EXPECT_TRUE(recording.is_whole(frame));
        const auto particles = recording.particles(frame);
        ASSERT_EQ(particles.positions.size(), 15U);
        EXPECT_EQ(particles.positions[3], 0.125F);
        EXPECT_EQ(particles.positions[11], i == 0 ? 0.0625F : 0.125F);
        ASSERT_TRUE(frame.mesh);
        EXPECT_EQ(recording.mesh(frame).mesh().triangles.size(), triangles);
    }
}

TEST(GoldenFiles, OfVersion2AreRead) {
    const auto recording = folder / "version_2.recording";
    EXPECT_FALSE(formats::Recording(recording).has_checksums());
    expect_golden_frames(recording);
    EXPECT_EQ(formats::read_mesh(folder / "version_2.bricks").triangles.size(), triangles);
}

TEST(GoldenFiles, OfVersion2WithChecksumsAreRead) {
    const auto recording = folder / "version_2_checksums.recording";
    EXPECT_TRUE(formats::Recording(recording).has_checksums());
    expect_golden_frames(recording);
}

TEST(GoldenFiles, ARecordingOfBeforeTheSmoothFieldGivesItsColorMeshesAgain) {
    const formats::Recording recording(folder / "version_2.recording");
    const Settings& settings = recording.settings();
    EXPECT_EQ(settings.field, Field::color);
    EXPECT_EQ(smoothing_length(settings), 2.0);
    EXPECT_EQ(settings.smoothness, std::nullopt);
    EXPECT_EQ(tolerance(settings), 0.15);
    Reconstructor reconstructor(settings, {.threads = 1});
    for (const formats::RecordedFrame& frame : recording.frames()) {
        Mesh mesh;
        reconstructor.reconstruct(recording.particles(frame).view(), mesh);
        EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(recording.mesh(frame).mesh())) << frame.index;
    }
}

TEST(BrickFile, OfALaterVersionIsRefusedWithItsNumber) {
    const std::string later = "Meniscus bricks\n\x02\x08\x07";
    EXPECT_EQ(
        refusal([&] { formats::read_bricks("f", later); }),
        "f: a file of bricks of format version 7; this program reads version 2: read it with the Meniscus that wrote "
        "it");
}

TEST(BrickFile, SkipsFieldsOfItsBeginningThatItDoesNotKnow) {
    const std::string whole = formats::read_file(folder / "version_2.bricks");
    const std::size_t after_beginning = std::string("Meniscus bricks\n\x02\x08\x02").size();
    // Field 100, of four bytes.
    const std::string later =
        "Meniscus bricks\n\x09\x08\x02\xa2\x06\x04"
        "hash" +
        whole.substr(after_beginning);
    EXPECT_EQ(formats::read_bricks("f", later).mesh().triangles.size(), triangles);
}

TEST(BrickFile, RefusesWhatIsNone) {
    EXPECT_EQ(refusal([] { formats::read_bricks("f", "something else"); }), "f: not a file of bricks");
    EXPECT_NE(refusal([] { formats::read_bricks("f", "Meniscus b"); }).find("truncated"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::test
