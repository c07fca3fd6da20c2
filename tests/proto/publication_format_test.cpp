// What the writers of publications share: the bytes of segments, and the room of a manifest.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "files/publication_format.hpp"
#include "files/publication_pace.hpp"
#include "files/publication_window.hpp"
#include "files/segment_file.hpp"

namespace meniscus::files::test {
namespace {

std::size_t beyond(const std::vector<double>& seconds, std::optional<double> keep) {
    return segments_beyond(seconds.size(), keep, [&](std::size_t i) { return seconds[i]; });
}

TEST(PublicationWindow, HasTheNewestSecondsWholeAndNoMore) {
    EXPECT_EQ(beyond({1, 1, 1, 1}, std::nullopt), 0U);
    EXPECT_EQ(beyond({1, 1, 1, 1}, 2.0), 2U);
    EXPECT_EQ(beyond({1, 1, 1, 1}, 2.5), 1U) << "of a segment whole";
    EXPECT_EQ(beyond({1, 1, 1, 1}, 9.0), 0U);
    EXPECT_EQ(beyond({}, 9.0), 0U);
}

TEST(PublicationWindow, HasNoMoreSegmentsThanAManifestLists) {
    const std::vector<double> many(max_segments + 7, 1.0);
    EXPECT_EQ(beyond(many, std::nullopt), 7U);
    EXPECT_EQ(beyond(many, 1e9), 7U);
    EXPECT_EQ(beyond(many, 2.0), many.size() - 2);
}

TEST(PublicationPace, ShowsAFrameForAsLongAsTheNextOneTookButNoPauseOfTheSimulator) {
    EXPECT_EQ(shown_seconds(std::nullopt), published_frame_seconds);
    EXPECT_EQ(shown_seconds(std::chrono::milliseconds(250)), 0.25);
    EXPECT_EQ(shown_seconds(std::chrono::hours(1)), 1.0);
}

/// A manifest of segments whose numbers have as many digits as any.
std::string long_manifest(std::size_t segments) {
    constexpr auto most = std::numeric_limits<std::uint64_t>::max();
    const double longest = -std::nextafter(std::numeric_limits<double>::min(), 0.0);
    v1::Publication wire;
    wire.set_frames(most);
    wire.set_bytes(most);
    for (std::size_t i = 0; i < segments; ++i) {
        v1::PublishedSegment& segment = *wire.add_segments();
        segment.set_sha256(std::string(64, 'f'));
        segment.set_bytes(std::numeric_limits<std::uint32_t>::max());
        segment.set_frames(std::numeric_limits<std::uint32_t>::max());
        segment.set_seconds(-longest);
        segment.set_first_frame(most);
        segment.set_last_frame(most);
        segment.set_first_time(longest);
        segment.set_last_time(longest);
        segment.set_run_id(most);
    }
    return manifest_json(std::move(wire));
}

TEST(Manifest, OfTheMostSegmentsHasRoomInWhatReadersTake) {
    const std::size_t of_one = long_manifest(101).size() - long_manifest(100).size();
    constexpr std::size_t of_the_rest = std::size_t{1} << 20;  // settings and attributes, whose number has a limit
    EXPECT_LE(of_one * max_segments + of_the_rest, max_manifest_bytes) << of_one;
}

TEST(SegmentFile, IsWithoutAFrameThatWasTakenBackAsIfItHadNeverBegun) {
    const auto with = [](bool more) {
        SegmentFile file;
        file.begin_frame(3, 0.5);
        file.add("first");
        if (more) {
            file.begin_frame(4, 0.6);
            file.add("half");
            file.take_back();
            EXPECT_EQ(file.last_index(), 3U);
        }
        file.begin_frame(5, 0.7);
        file.add("second");
        return file.build().bytes;
    };
    EXPECT_EQ(with(true), with(false));
    SegmentFile file;
    file.begin_frame(3, 0.5);
    file.take_back();
    EXPECT_TRUE(file.empty());
    EXPECT_EQ(file.bytes(), 0U);
}

}  // namespace
}  // namespace meniscus::files::test
