// The publications of all sessions: their memory, and what becomes of them after their sessions.
#include "publishing/publications.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "files/publication_pace.hpp"
#include "published_frames.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using Clock = Publication::Clock;

constexpr std::size_t most_ended = 3;

std::string id_of(int number) {
    return "00000000-0000-0000-0000-00000000000" + std::to_string(number);
}

SessionIdentity identity(int number, const std::string& owner = {}) {
    return {.id = id_of(number), .owner = owner, .kind = {.publish = true}};
}

/// A frame that is a segment by itself.
std::shared_ptr<const EncodedFrame> large_frame(std::uint64_t index) {
    return std::make_shared<const EncodedFrame>(encoded_frame(index, {std::string(files::segment_bytes, 'x')}));
}

constexpr std::size_t limit = 10 * (files::segment_bytes + 1000);

struct Published {
    Publications all{{.enabled = true, .keep = std::chrono::minutes(1), .limit = limit}, most_ended};
};

TEST(Publications, StayWithinTheirMemoryByWhatTheLargestLose) {
    Published published;
    std::vector<std::shared_ptr<SessionObserver>> sessions;
    sessions.reserve(3);
    for (int i = 0; i < 3; ++i) sessions.push_back(published.all.observe(identity(i), settings()));
    for (std::uint64_t frame = 0; frame < 3; ++frame) sessions[0]->encoded(large_frame(frame));
    for (std::uint64_t frame = 0; frame < 40; ++frame) sessions[1]->encoded(large_frame(frame));
    std::size_t bytes = 0;
    for (int i = 0; i < 3; ++i) bytes += published.all.find(id_of(i))->bytes();
    EXPECT_LE(bytes, limit);
    EXPECT_GT(bytes, limit - 2 * files::segment_bytes);
    EXPECT_EQ(manifest_of(*published.all.find(id_of(0))).frames(), 3U) << "the small one has all";
    const v1::Publication large = manifest_of(*published.all.find(id_of(1)));
    EXPECT_EQ(large.frames() + large.left_frames(), 40U);
    EXPECT_EQ(large.segments(large.segments_size() - 1).last_frame(), 39U) << "the newest stay";
    EXPECT_EQ(published.all.counters().left_out, large.left_frames());
}

TEST(Publications, OfEndedSessionsMakeRoomFirst) {
    Published published;
    std::vector<std::shared_ptr<SessionObserver>> sessions;
    sessions.reserve(3);
    for (int i = 0; i < 3; ++i) sessions.push_back(published.all.observe(identity(i), settings()));
    for (std::uint64_t frame = 0; frame < 3; ++frame)
        for (const auto& session : sessions) session->encoded(large_frame(frame));
    sessions[0]->ended();
    sessions[1]->ended();
    const auto frames = [&](int i) { return manifest_of(*published.all.find(id_of(i))).frames(); };
    for (std::uint64_t frame = 3; frame < 6; ++frame) sessions[2]->encoded(large_frame(frame));
    EXPECT_EQ(frames(0), 1U) << "that has ended first";
    EXPECT_EQ(frames(1), 3U);
    for (std::uint64_t frame = 6; frame < 9; ++frame) sessions[2]->encoded(large_frame(frame));
    EXPECT_EQ(frames(0), 0U);
    EXPECT_EQ(frames(1), 1U);
    EXPECT_EQ(frames(2), 9U) << "the largest, whose session lives";
}

/// Frames of a session's publication; none: it is not there.
std::uint64_t frames_of(const Published& published, int number) {
    const auto publication = published.all.find(id_of(number));
    return publication ? manifest_of(*publication).frames() : 0;
}

TEST(Publications, OfAnOwnerMakeRoomForItsOwnBeforeThoseOfOthersWhoHoldLess) {
    Published published;
    const auto of_ben = published.all.observe(identity(0, "ben"), settings());
    for (std::uint64_t frame = 0; frame < 3; ++frame) of_ben->encoded(large_frame(frame));
    of_ben->ended();
    // Of Ada's sessions one has ended, and the others go on for long.
    std::vector<std::shared_ptr<SessionObserver>> of_ada;
    for (int i = 1; i < 5; ++i) of_ada.push_back(published.all.observe(identity(i, "ada"), settings()));
    for (std::uint64_t frame = 0; frame < 4; ++frame) of_ada[0]->encoded(large_frame(frame));
    of_ada[0]->ended();
    for (std::uint64_t frame = 0; frame < 5; ++frame) of_ada[1]->encoded(large_frame(frame));
    EXPECT_EQ(frames_of(published, 1), 2U) << "her own that has ended gives first";
    for (std::uint64_t frame = 5; frame < 20; ++frame)
        for (std::size_t i = 1; i < 4; ++i) of_ada[i]->encoded(large_frame(frame));
    EXPECT_EQ(frames_of(published, 0), 3U) << "of Ben, who holds less";
    EXPECT_EQ(frames_of(published, 1), 0U);
    EXPECT_EQ(frames_of(published, 2) + frames_of(published, 3) + frames_of(published, 4), 7U);
}

TEST(Publications, OfTwoOwnersWhoWantAllHaveHalfEach) {
    Published published;
    const auto of_ada = published.all.observe(identity(0, "ada"), settings());
    const auto of_ben = published.all.observe(identity(1, "ben"), settings());
    for (std::uint64_t frame = 0; frame < 20; ++frame) of_ada->encoded(large_frame(frame));
    EXPECT_EQ(frames_of(published, 0), 10U);
    for (std::uint64_t frame = 0; frame < 20; ++frame) of_ben->encoded(large_frame(frame));
    EXPECT_EQ(frames_of(published, 0), 5U);
    EXPECT_EQ(frames_of(published, 1), 5U);
}

TEST(Publications, GoByTheirIdsWhereTheCallerMayAndFreeTheirMemory) {
    Published published;
    const auto of_ben = published.all.observe(identity(0, "ben"), settings());
    of_ben->encoded(large_frame(0));
    const auto may = [](const std::string& caller) {
        return [caller](const std::string& owner) { return owner == caller; };
    };
    EXPECT_FALSE(published.all.remove(id_of(0), may("ada")));
    EXPECT_FALSE(published.all.remove(id_of(1), may("ben")));
    EXPECT_EQ(published.all.count(), 1U);
    EXPECT_TRUE(published.all.remove(id_of(0), may("ben")));
    EXPECT_FALSE(published.all.find(id_of(0)));
    of_ben->encoded(large_frame(1));
    EXPECT_FALSE(published.all.find(id_of(0))) << "nor by what its session still does";
}

TEST(Publications, AreSentUntilReadersHoldTooMuchThatHasLeft) {
    Published published;
    const auto session = published.all.observe(identity(0), settings());
    const auto publication = published.all.find(id_of(0));
    std::vector<std::shared_ptr<const PublishedFile>> read;
    for (std::uint64_t frame = 0; frame < 40; ++frame) {
        session->encoded(large_frame(frame));
        if (!published.all.may_be_sent()) continue;
        const v1::Publication manifest = manifest_of(*publication);
        read.push_back(publication->find(manifest.segments(manifest.segments_size() - 1).sha256() + ".segment"));
    }
    EXPECT_FALSE(published.all.may_be_sent());
    EXPECT_LT(published.all.counters().held, 3 * limit);
    read.clear();
    EXPECT_TRUE(published.all.may_be_sent());
}

TEST(Publications, EndWithASessionThatCouldNotBeMade) {
    Published published;
    published.all.observe(identity(0), settings()).reset();
    EXPECT_FALSE(manifest_of(*published.all.find(id_of(0))).live());
    published.all.tidy(Clock::now() + std::chrono::minutes(2));
    EXPECT_EQ(published.all.count(), 0U);
}

TEST(Publications, GoOnWithASessionOfTheSameOwnerAndSettingsAlone) {
    Published published;
    const auto publish = [&](const std::string& owner, const Settings& of) {
        const auto session = published.all.observe(identity(1, owner), of);
        session->encoded(std::make_shared<const EncodedFrame>(encoded_frame(0, {"a"}, 0)));
        session->ended();
        return manifest_of(*published.all.find(id_of(1))).frames();
    };
    EXPECT_EQ(publish("ada", settings()), 1U);
    EXPECT_EQ(publish("ada", settings()), 2U);
    EXPECT_EQ(publish("ben", settings()), 1U) << "nobody's surface is shown under the name of another";
    EXPECT_EQ(published.all.find(id_of(1))->owner(), "ben");
    Settings others = settings();
    others.iso = 0.5;
    EXPECT_EQ(publish("ben", others), 1U);
    EXPECT_EQ(published.all.count(), 1U);
}

TEST(Publications, AreForgottenSomeTimeAfterTheirSessionsAndTheLongestEndedFirst) {
    Published published;
    std::vector<std::shared_ptr<SessionObserver>> sessions;
    sessions.reserve(6);
    for (int i = 0; i < 6; ++i) sessions.push_back(published.all.observe(identity(i), settings()));
    for (int i = 0; i < 5; ++i) sessions[static_cast<std::size_t>(i)]->ended();
    published.all.tidy(Clock::now());
    EXPECT_EQ(published.all.count(), most_ended + 1);
    EXPECT_FALSE(published.all.find(id_of(0)));
    EXPECT_TRUE(published.all.find(id_of(4)));
    EXPECT_FALSE(manifest_of(*published.all.find(id_of(4))).live());
    published.all.tidy(Clock::now() + std::chrono::seconds(59));
    EXPECT_EQ(published.all.count(), most_ended + 1);
    published.all.tidy(Clock::now() + std::chrono::minutes(2));
    EXPECT_EQ(published.all.count(), 1U) << "that of the session that lives";
    EXPECT_TRUE(published.all.find(id_of(5)));
}

TEST(Publications, OfEndedSessionsAreForgottenOfTheOwnerWhoHasMost) {
    Published published;
    std::vector<std::shared_ptr<SessionObserver>> sessions;
    sessions.push_back(published.all.observe(identity(0, "ben"), settings()));
    sessions.back()->ended();
    for (int i = 1; i < 8; ++i) {
        sessions.push_back(published.all.observe(identity(i, "ada"), settings()));
        sessions.back()->ended();
        published.all.tidy(Clock::now());
    }
    EXPECT_EQ(published.all.count(), most_ended);
    EXPECT_TRUE(published.all.find(id_of(0))) << "the longest ended, and the only one of its owner";
    EXPECT_FALSE(published.all.find(id_of(5)));
    EXPECT_TRUE(published.all.find(id_of(7)));
}

}  // namespace
}  // namespace meniscus::server::test
