// Published frames are read back, whatever happens to the writer between.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/client/publication_writer.hpp"
#include "publications/published_frames.hpp"
#include "sample_files.hpp"

namespace meniscus::test {
namespace {

using client::Publication;
using client::PublicationWriter;

/// Frames of 40 ms, of which 25 are a segment.
constexpr double frame_seconds = 0.04;

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
    return names;
}

/// The names of the files that the manifest lists, and its own.
std::set<std::string> names_of(const Publication& publication) {
    std::set<std::string> names{"manifest.json"};
    for (const auto& segment : publication.info().segments) names.insert(segment.file());
    return names;
}

TEST(Publication, GivesTheMeshesThatWereAddedInAnyOrder) {
    for (const Codec codec : codecs) {
        const TemporaryDirectory folder;
        Row row;
        std::vector<std::string> hashes;
        {
            PublicationWriter writer(folder.path(), published_settings(), {});
            for (std::uint64_t i = 0; i < 60; ++i) {
                writer.add(row.frame(i, 0, codec), frame_seconds);
                hashes.push_back(row.sha256());
            }
            writer.finish();
        }
        Publication publication(folder.path());
        EXPECT_FALSE(publication.info().live);
        ASSERT_EQ(publication.info().frames, 60U);
        EXPECT_EQ(publication.info().segments.size(), 3U);
        EXPECT_EQ(names_in(folder.path()), names_of(publication));
        for (std::uint64_t i = 0; i < 60; ++i) EXPECT_EQ(mesh_sha256(publication.frame(i).mesh()), hashes[i]) << i;
        std::mt19937 random(1);
        for (int seek = 0; seek < 60; ++seek) {
            const std::uint64_t place = random() % 60;
            const client::ReceivedFrame frame = publication.frame(place);
            EXPECT_EQ(frame.index, place);
            EXPECT_EQ(mesh_sha256(frame.mesh()), hashes[place]) << place;
        }
    }
}

TEST(Publication, SaysWhatWasPublished) {
    const TemporaryDirectory folder;
    Row row;
    PublicationWriter writer(folder.path(), published_settings(),
                             {.description = {.name = "row", .up_axis = client::UpAxis::z, .length_unit = "m"},
                              .normals_by = client::NormalsBy::receiver,
                              .live = true});
    writer.add(row.frame(3, 7), 0.5);
    writer.add(row.frame(5, 7), 0.25);
    writer.flush();
    const client::PublicationInfo info = Publication(folder / "manifest.json").info();
    EXPECT_EQ(info.settings, in_force(published_settings()));
    EXPECT_EQ(info.description.name, "row");
    EXPECT_EQ(info.description.up_axis, client::UpAxis::z);
    EXPECT_EQ(info.description.length_unit, "m");
    EXPECT_EQ(info.normals_by, client::NormalsBy::receiver);
    EXPECT_TRUE(info.live);
    ASSERT_EQ(info.attributes.size(), 1U);
    EXPECT_EQ(info.attributes[0].name, "age");
    EXPECT_EQ(info.attributes[0].range->maximum[0], 1.0);
    ASSERT_EQ(info.segments.size(), 1U);
    const client::PublishedSegment& segment = info.segments[0];
    EXPECT_EQ(segment.frames, 2U);
    EXPECT_EQ(segment.seconds, 0.75);
    EXPECT_EQ(segment.first_frame, 3U);
    EXPECT_EQ(segment.last_frame, 5U);
    EXPECT_DOUBLE_EQ(segment.last_time, 0.5);
    EXPECT_EQ(segment.run_id, 7U);
    EXPECT_EQ(segment.bytes, std::filesystem::file_size(folder / segment.file()));
}

TEST(Publication, BricksThatStayAreWrittenOncePerSegment) {
    const TemporaryDirectory together, alone;
    Row row;
    PublicationWriter writer(together.path(), published_settings(), {});
    PublicationWriter of_whole_frames(alone.path(), published_settings(), {.segment_bytes = 1});
    for (std::uint64_t i = 0; i < 20; ++i) {
        const client::ReceivedFrame frame = row.frame(i);
        writer.add(frame, frame_seconds);
        of_whole_frames.add(frame, frame_seconds);
    }
    writer.finish();
    EXPECT_EQ(of_whole_frames.info().segments.size(), 20U);
    EXPECT_LT(writer.info().bytes, of_whole_frames.info().bytes * 2 / 3);
}

TEST(Publication, ASegmentEndsByItsTimeByItsBytesAndBeforeAnotherRun) {
    const TemporaryDirectory folder;
    Row row;
    PublicationWriter writer(folder.path(), published_settings(), {.segment_seconds = 1.0, .segment_bytes = 1U << 20});
    writer.add(row.frame(0, 1), 0.5);
    EXPECT_TRUE(writer.is_open());
    writer.add(row.frame(1, 1), 0.5);
    EXPECT_FALSE(writer.is_open());
    writer.add(row.frame(2, 1), 0.1);
    writer.add(row.frame(0, 2), 0.1);  // another run
    writer.add(row.frame(0, 2), 0.1);  // no greater index
    writer.finish();
    std::vector<std::uint64_t> frames;
    for (const auto& segment : writer.info().segments) frames.push_back(segment.frames);
    EXPECT_EQ(frames, (std::vector<std::uint64_t>{2, 1, 1, 1}));

    const TemporaryDirectory small;
    PublicationWriter by_bytes(small.path(), published_settings(), {.segment_bytes = 1});
    for (std::uint64_t i = 0; i < 3; ++i) by_bytes.add(row.frame(i), frame_seconds);
    EXPECT_EQ(by_bytes.info().segments.size(), 3U);
}

TEST(Publication, GoesOnAfterAWriterThatWasKilled) {
    const TemporaryDirectory folder;
    Row row;
    {
        PublicationWriter writer(folder.path(), published_settings(), {});
        for (std::uint64_t i = 0; i < 30; ++i) writer.add(row.frame(i), frame_seconds);
    }
    // Files that such a writer may leave behind it.
    const std::string nobodys(64, 'a');
    for (const char* const name : {".segment", ".segment.partial"}) std::ofstream(folder / (nobodys + name)) << "half";
    std::ofstream(folder / "index.html") << "somebody's";
    {
        PublicationWriter writer(folder.path(), published_settings(), {});
        EXPECT_TRUE(writer.has(0, 24));
        EXPECT_FALSE(writer.has(0, 25));  // the segment was open
        EXPECT_FALSE(writer.has(1, 3));
        for (std::uint64_t i = 0; i < 30; ++i)
            if (!writer.has(0, i)) writer.add(row.frame(i), frame_seconds);
        writer.finish();
    }
    Publication publication(folder.path());
    ASSERT_EQ(publication.info().frames, 30U);
    for (std::uint64_t i = 0; i < 30; ++i) EXPECT_EQ(publication.frame(i).index, i);
    std::set<std::string> names = names_of(publication);
    names.insert("index.html");
    EXPECT_EQ(names_in(folder.path()), names);
}

TEST(Publication, RefusesAWriterWithOtherSettingsAndASecondOne) {
    const TemporaryDirectory folder;
    const PublicationWriter writer(folder.path(), published_settings(), {});
    EXPECT_NE(refusal([&] { PublicationWriter(folder.path(), published_settings(), {}); }).find("another process"),
              std::string::npos);
    const TemporaryDirectory other;
    { const PublicationWriter first(other.path(), published_settings(), {}); }
    Settings settings = published_settings();
    settings.iso = 0.5;
    EXPECT_NE(refusal([&] { PublicationWriter(other.path(), settings, {}); }).find("other settings"),
              std::string::npos);
}

TEST(Publication, GoesOnWhereSettingsAreNotKnown) {
    const TemporaryDirectory folder;
    Row row;
    for (std::uint64_t i = 0; i < 2; ++i) {
        PublicationWriter writer(folder.path(), std::nullopt, {});
        writer.add(row.frame(i), frame_seconds);
        writer.finish();
    }
    const client::PublicationInfo info = Publication(folder.path()).info();
    EXPECT_FALSE(info.settings);
    EXPECT_EQ(info.frames, 2U);
}

TEST(Publication, KeepsTheNewestSecondsAndTheirPlaces) {
    const TemporaryDirectory folder;
    Row row;
    PublicationWriter writer(folder.path(), published_settings(),
                             {.live = true, .segment_seconds = 1.0, .keep_seconds = 2.0});
    for (std::uint64_t i = 0; i < 10; ++i) writer.add(row.frame(i), 0.5);
    Publication publication(folder.path());
    EXPECT_EQ(publication.info().left_frames, 6U);
    EXPECT_EQ(publication.info().frames, 4U);
    EXPECT_EQ(publication.frame(9).index, 9U);
    EXPECT_NE(refusal([&] { publication.frame(5); }), "");
    EXPECT_NE(refusal([&] { publication.frame(10); }), "");
    // Files that the manifest has dropped stay for readers of the manifest before, until the end.
    EXPECT_GT(names_in(folder.path()).size(), names_of(publication).size());
    writer.finish();
    EXPECT_EQ(names_in(folder.path()), names_of(publication));
}

TEST(Publication, ALiveOneIsReadAgainForTheFramesThatHaveCome) {
    const TemporaryDirectory folder;
    Row row;
    PublicationWriter writer(folder.path(), published_settings(), {.live = true});
    Publication publication(folder.path());
    EXPECT_EQ(publication.info().frames, 0U);
    writer.add(row.frame(0), frame_seconds);
    writer.flush();
    publication.refresh();
    EXPECT_EQ(publication.frame(0).index, 0U);
    writer.finish();
    publication.refresh();
    EXPECT_FALSE(publication.info().live);
}

TEST(Publication, IsReadWhileItsManifestIsReplaced) {
    const TemporaryDirectory folder;
    Row row;
    PublicationWriter writer(folder.path(), published_settings(), {.live = true});
    constexpr std::uint64_t count = 200;
    std::jthread writes([&] {
        for (std::uint64_t i = 0; i < count; ++i) {
            writer.add(row.frame(i), frame_seconds);
            writer.flush();
        }
    });
    for (std::uint64_t frames = 0; frames < count;) {
        const std::uint64_t there = Publication(folder.path()).info().frames;
        ASSERT_GE(there, frames);
        frames = there;
    }
}

}  // namespace
}  // namespace meniscus::test
