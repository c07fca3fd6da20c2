// A publication in the server's memory, by a clock of the test's.
#include "publishing/publication.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files/publication_format.hpp"
#include "files/publication_pace.hpp"
#include "meniscus/error.hpp"
#include "meniscus/sha256.hpp"
#include "published_frames.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using Clock = Publication::Clock;

class PublicationOfASession : public testing::Test {
protected:
    void add(std::uint64_t index, double at, const std::vector<std::string>& bricks = {"a"}, std::uint64_t run = 7) {
        publication.add(turn, encoded_frame(index, bricks, run), time(at));
    }
    Clock::time_point time(double seconds) const {
        return start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
    v1::Publication manifest() const { return manifest_of(publication); }

    const Clock::time_point start = Clock::now();
    const std::shared_ptr<PublishingCounters> counters = std::make_shared<PublishingCounters>();
    static constexpr std::size_t limit = std::size_t{4} << 20;
    Publication publication{
        "ada", settings(), {.enabled = true, .keep = std::chrono::seconds(10), .limit = limit}, counters};
    std::uint64_t turn = publication.begin({});
};

TEST_F(PublicationOfASession, ListsASegmentOnceItHasEndedByTimeOrBytes) {
    add(0, 0.0);
    add(1, 0.5);
    EXPECT_EQ(manifest().segments_size(), 0);
    EXPECT_TRUE(manifest().live());
    publication.tidy(time(0.99));
    EXPECT_EQ(manifest().segments_size(), 0);
    publication.tidy(time(1.0));
    ASSERT_EQ(manifest().segments_size(), 1) << "though no other frame comes";
    EXPECT_EQ(manifest().frames(), 2U);
    add(2, 1.5);
    add(3, 2.5);
    ASSERT_EQ(manifest().segments_size(), 2) << "with the frame that ends its second";
    EXPECT_EQ(manifest().segments(1).last_frame(), 3U);
    add(4, 2.6, {std::string(files::segment_bytes, 'x')});
    ASSERT_EQ(manifest().segments_size(), 3) << "a large frame is one by itself";
    EXPECT_EQ(manifest().segments(2).frames(), 1U);
}

TEST_F(PublicationOfASession, RefusesAFrameThatHasNoRoomByItselfAndKeepsTheOthers) {
    add(0, 0.0);
    EXPECT_THROW(add(1, 0.1, {std::string(limit, 'x')}), LimitExceeded);
    add(2, 0.2);
    EXPECT_EQ(counters->left_out, 1U);
    publication.end(turn, time(0.5));
    const v1::Publication all = manifest();
    ASSERT_EQ(all.frames(), 2U);
    EXPECT_EQ(all.segments(all.segments_size() - 1).last_frame(), 2U);
    EXPECT_EQ(counters->held, all.bytes() + publication.find("manifest.json")->bytes.size()) << "no byte of it is held";
}

TEST_F(PublicationOfASession, NeverListsMoreThanItsLimitAndLosesTheOldest) {
    const std::string half(limit / 2 - 1000, 'x');
    for (std::uint64_t frame = 0; frame < 5; ++frame) {
        add(frame, 2.0 * static_cast<double>(frame), {std::to_string(frame) + half});
        const v1::Publication all = manifest();
        EXPECT_LE(all.bytes(), limit);
        EXPECT_EQ(all.frames() + all.left_frames(), frame + 1);
        EXPECT_EQ(all.segments(all.segments_size() - 1).last_frame(), frame) << "the newest stays";
        EXPECT_EQ(counters->left_out, all.left_frames());
    }
    EXPECT_EQ(manifest().frames(), 2U);
}

TEST_F(PublicationOfASession, HasSegmentsByTheHashOfTheirBytes) {
    for (int i = 0; i < 5; ++i) add(static_cast<std::uint64_t>(i), i);
    publication.end(turn, time(5));
    const v1::Publication all = manifest();
    std::uint64_t bytes = 0;
    for (const v1::PublishedSegment& segment : all.segments()) {
        const auto file = publication.find(segment.sha256() + ".segment");
        ASSERT_TRUE(file);
        EXPECT_EQ(sha256_of(file->bytes), segment.sha256());
        EXPECT_EQ(file->bytes.size(), segment.bytes());
        EXPECT_TRUE(file->bytes.starts_with(files::segment_magic));
        bytes += file->bytes.size();
    }
    EXPECT_EQ(all.bytes(), bytes);
    for (const char* name : {"", "segment", ".segment", "manifest.json/", "MANIFEST.JSON", "../manifest.json"})
        EXPECT_FALSE(publication.find(name)) << name;
}

TEST_F(PublicationOfASession, SendsAnUnchangedBrickOnceInASegmentAndOnceInEach) {
    const std::string large(10'000, 'l');
    add(0, 0.0, {large, "a"});
    add(1, 0.1, {large, "b"});
    add(2, 0.2, {large, "c"});
    publication.tidy(time(1.5));
    add(3, 1.6, {large, "c"});
    publication.tidy(time(3.0));
    ASSERT_EQ(manifest().segments_size(), 2);
    EXPECT_LT(manifest().segments(0).bytes(), 2 * large.size());
    EXPECT_GT(manifest().segments(1).bytes(), large.size()) << "it is read without the one before";
}

TEST_F(PublicationOfASession, BeginsASegmentWithEachRunAndWhereIndicesBeginAgain) {
    add(0, 0.0, {"a"}, 7);
    add(1, 0.1, {"a"}, 7);
    add(0, 0.2, {"a"}, 8);
    add(0, 0.3, {"a"}, 8);
    publication.end(turn, time(0.4));
    const v1::Publication all = manifest();
    ASSERT_EQ(all.segments_size(), 3);
    EXPECT_EQ(all.segments(0).run_id(), 7U);
    EXPECT_EQ(all.segments(0).frames(), 2U);
    EXPECT_EQ(all.segments(1).run_id(), 8U);
    EXPECT_EQ(all.segments(2).run_id(), 8U);
}

TEST_F(PublicationOfASession, KeepsItsSecondsAndFilesForReadersWhoAreBehind) {
    for (int i = 0; i < 40; ++i) add(static_cast<std::uint64_t>(i), i);
    const v1::Publication kept = manifest();
    double seconds = 0.0;
    for (const auto& segment : kept.segments()) seconds += segment.seconds();
    EXPECT_GE(seconds, 10.0);
    EXPECT_LE(seconds - kept.segments(0).seconds(), 10.0);
    EXPECT_EQ(kept.left_frames() + kept.frames(), 40U);
    const std::size_t with_those_that_left = publication.bytes();
    EXPECT_GT(with_those_that_left, kept.bytes()) << "a reader may have an earlier manifest";
    publication.tidy(time(40 + 31));
    EXPECT_EQ(publication.bytes(), kept.bytes());
    EXPECT_EQ(manifest().SerializeAsString(), kept.SerializeAsString()) << "a pause takes nothing away";
}

TEST_F(PublicationOfASession, HasNoFrameTwiceThatASessionIsSentAgainThatWasCreatedAnew) {
    for (std::uint64_t i = 0; i < 4; ++i) add(i, 0.1 * static_cast<double>(i));
    publication.end(turn, time(1));
    EXPECT_FALSE(manifest().live());
    turn = publication.begin({});
    EXPECT_TRUE(manifest().live());
    for (std::uint64_t i = 2; i < 6; ++i) add(i, 2.0);
    publication.end(turn, time(3));
    const v1::Publication all = manifest();
    ASSERT_EQ(all.segments_size(), 2);
    EXPECT_EQ(all.segments(1).first_frame(), 4U);
    EXPECT_EQ(all.frames(), 6U);
}

TEST_F(PublicationOfASession, TakesNothingOfASessionWhoseTurnIsOver) {
    add(0, 0.0);
    const std::uint64_t earlier = turn;
    turn = publication.begin({});
    publication.add(earlier, encoded_frame(1, {"a"}), time(0.1));
    publication.end(earlier, time(0.2));
    EXPECT_TRUE(manifest().live());
    publication.end(turn, time(0.25));
    EXPECT_FALSE(manifest().live());
    EXPECT_EQ(manifest().frames(), 1U);
    EXPECT_EQ(publication.ended_for(time(1.25)), std::chrono::seconds(1));
}

TEST_F(PublicationOfASession, SaysTheRangesOfAllItsFrames) {
    const auto with = [](std::uint64_t index, const std::vector<double>& range, bool carried) {
        EncodedFrame frame = encoded_frame(index, {"a"});
        v1::MeshAttribute& attribute = *frame.attributes.Add();
        attribute.set_name("speed");
        attribute.set_type(v1::ATTRIBUTE_TYPE_FLOAT32);
        attribute.set_components(1);
        if (carried) attribute.set_bits(8);
        if (range.empty()) return frame;
        attribute.add_minimum(range[0]);
        attribute.add_maximum(range[1]);
        return frame;
    };
    publication.add(turn, with(0, {-9, 9}, false), time(0));
    EXPECT_EQ(manifest().attributes_size(), 0) << "the bricks do not carry it";
    publication.add(turn, with(1, {}, true), time(0));
    publication.add(turn, with(2, {1, 2}, true), time(0));
    publication.add(turn, with(3, {}, true), time(0));
    publication.add(turn, with(4, {-3, 1.5}, true), time(0));
    publication.end(turn, time(1));
    const v1::Publication all = manifest();
    ASSERT_EQ(all.attributes_size(), 1);
    EXPECT_EQ(all.attributes(0).minimum(0), -3.0);
    EXPECT_EQ(all.attributes(0).maximum(0), 2.0);
    EXPECT_FALSE(all.attributes(0).has_bits());
}

TEST_F(PublicationOfASession, CountsTheBytesThatAReaderHoldsOn) {
    for (int i = 0; i < 3; ++i) add(static_cast<std::uint64_t>(i), i);
    publication.end(turn, time(3));
    auto held = publication.find(manifest().segments(0).sha256() + ".segment");
    ASSERT_TRUE(held);
    while (publication.bytes() != 0) publication.drop_oldest();
    EXPECT_EQ(manifest().segments_size(), 0);
    EXPECT_EQ(manifest().left_frames(), 3U);
    EXPECT_EQ(counters->left_out, 3U);
    const std::uint64_t manifest_bytes = publication.find("manifest.json")->bytes.size();
    EXPECT_EQ(counters->held, held->bytes.size() + manifest_bytes);
    held.reset();
    EXPECT_EQ(counters->held, manifest_bytes);
}

}  // namespace
}  // namespace meniscus::server::test
