// Sessions that go with their stream; times are given to the registry, not waited for.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "opened_upload.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/session/session_registry.hpp"
#include "simulator_player.hpp"

namespace meniscus::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::hours;
using std::chrono::milliseconds;

/// Far more than the tests take: nothing ends by itself meanwhile.
constexpr auto kept = hours(1);
constexpr auto orphaned = hours(100);

struct EphemeralSession : testing::Test {
    explicit EphemeralSession(std::chrono::milliseconds orphan_time = orphaned)
        : registry(Limits{.sessions = 1000, .orphan_time = orphan_time, .ephemeral_time = kept},
                   BackendOptions{.backend = Backend::cpu, .threads = 1}, 1) {}

    std::shared_ptr<Session> create() {
        return registry.create(test::id, test::settings(), {}, {.ephemeral = true}).session;
    }
    static std::shared_ptr<Upload> open(Session& session, milliseconds reconnect = {}) {
        return test::open_upload(session, {.run_id = 7, .reconnect = reconnect});
    }
    static void wait_for_end(Session& session) {
        while (!session.without_stream(Clock::now())) std::this_thread::yield();
    }
    /// Whether it is there after this time.
    bool is_there_after(Clock::duration time) {
        registry.end_idle(Clock::now() + time);
        return !registry.list().empty();
    }

    SessionRegistry registry;
};

struct ShortlyOrphanedSession : EphemeralSession {
    ShortlyOrphanedSession() : EphemeralSession(hours(2)) {}
};

constexpr auto a_little = std::chrono::minutes(1);

TEST_F(EphemeralSession, HasBeenWithoutAStreamForNoTimeWhereThatBeganSinceOneLooked) {
    const auto looked = Clock::now() - a_little;
    EXPECT_EQ(create()->without_stream(looked), Clock::duration::zero());
}

TEST_F(EphemeralSession, GoesSoonAfterItsCreationWithoutAStreamThoughItIsWatchedAndAskedFor) {
    const auto session = create();
    std::exception_ptr error;
    const auto watch = session->open_watch({}, [] {});
    registry.find(test::id);
    EXPECT_TRUE(is_there_after(kept - a_little));
    EXPECT_FALSE(is_there_after(kept));
    const auto end = std::get<Watch::End>(watch->take());
    EXPECT_FALSE(end.error) << "as with any session that ends";
}

TEST_F(EphemeralSession, StaysWhileItsStreamIsOpenOrAwaitsAnswers) {
    const auto session = create();
    const auto upload = open(*session);
    EXPECT_TRUE(is_there_after(10 * orphaned));
    session->end_upload(upload, nullptr);
    wait_for_end(*session);
    EXPECT_TRUE(is_there_after(kept - a_little));
    EXPECT_FALSE(is_there_after(kept));
}

TEST_F(EphemeralSession, IsKeptForAsLongAsTheSimulatorOfABrokenStreamTriesToComeBack) {
    const auto session = create();
    session->cancel_upload(open(*session, hours(5)), UploadEnd::vanished);
    EXPECT_TRUE(is_there_after(hours(5) - a_little));
    const auto again = open(*session, hours(5));
    EXPECT_TRUE(is_there_after(10 * orphaned));
    session->cancel_upload(again, UploadEnd::vanished);
    EXPECT_TRUE(is_there_after(hours(5) - a_little));
    EXPECT_FALSE(is_there_after(hours(5)));
}

TEST_F(EphemeralSession, IsKeptForASimulatorWhoseBrokenStreamLookedAsIfItHadEndedWell) {
    const auto session = create();
    const auto upload = open(*session, hours(5));
    session->end_upload(upload, nullptr);
    wait_for_end(*session);
    session->cancel_upload(upload, UploadEnd::vanished);
    EXPECT_TRUE(is_there_after(hours(5) - a_little));
    EXPECT_FALSE(is_there_after(hours(5)));
}

TEST_F(EphemeralSession, WaitsForABrokenStreamThoughAnEarlierOneOfItsRunEndsLater) {
    const auto session = create();
    const auto earlier = open(*session);
    const auto later = open(*session, 3 * kept);
    session->cancel_upload(later, UploadEnd::vanished);
    session->end_upload(earlier, nullptr);
    wait_for_end(*session);
    EXPECT_TRUE(is_there_after(3 * kept - a_little));
    EXPECT_FALSE(is_there_after(3 * kept + a_little));
}

TEST_F(EphemeralSession, IsNotKeptForASimulatorThatHasAllItsAnswers) {
    const auto session = create();
    session->cancel_upload(open(*session, hours(5)), UploadEnd::answered);
    EXPECT_FALSE(is_there_after(kept));
}

TEST_F(EphemeralSession, IsKeptNoShorterThanWithoutATryToComeBack) {
    const auto session = create();
    session->cancel_upload(open(*session, milliseconds(1)), UploadEnd::vanished);
    EXPECT_TRUE(is_there_after(kept - a_little));
    EXPECT_FALSE(is_there_after(kept));
}

TEST_F(ShortlyOrphanedSession, IsKeptNoLongerThanSessionsOfVanishedSimulators) {
    const auto session = create();
    session->cancel_upload(open(*session, hours(24 * 365)), UploadEnd::vanished);
    EXPECT_TRUE(is_there_after(hours(2) - a_little));
    EXPECT_FALSE(is_there_after(hours(2)));
}

TEST_F(EphemeralSession, ThatIsCreatedOnceMoreIsKeptAsANewOneAndStaysWhatItWas) {
    auto now = Clock::now();
    const auto session = create();
    while (Clock::now() - now < milliseconds(2)) std::this_thread::yield();
    now = Clock::now();
    const auto again = registry.create(test::id, test::settings());
    EXPECT_FALSE(again.is_new);
    EXPECT_TRUE(again.session->kind().ephemeral);
    registry.end_idle(now + kept - milliseconds(1));
    EXPECT_FALSE(registry.list().empty());
}

TEST_F(EphemeralSession, MayBeDeletedByItsOwnerAsItsTimeEnds) {
    for (int round = 0; round < 200; ++round) {
        const auto session = create();
        std::thread ending([&] { registry.end_idle(Clock::now() + kept); });
        try {
            registry.remove(session);
        } catch (const Refusal& refusal) {
            EXPECT_EQ(refusal.kind(), Refusal::Kind::not_found);
        }
        ending.join();
        EXPECT_TRUE(registry.list().empty());
        EXPECT_TRUE(session->ended());
    }
}

TEST_F(EphemeralSession, IsNoneThatWasNotCreatedAsOne) {
    const auto session = registry.create(test::id, test::settings()).session;
    session->cancel_upload(open(*session, milliseconds(1)), UploadEnd::answered);
    EXPECT_TRUE(is_there_after(10 * orphaned));
}

/// The refusals of a server without room.
struct FullRegistry : testing::Test {
    std::string refusal(const Creator& creator) {
        try {
            registry.create(id_of(99), test::settings(), creator);
        } catch (const LimitExceeded& error) {
            return error.what();
        }
        return {};
    }
    static std::string id_of(int number) { return fmt::format("00000000-0000-4000-8000-0000000000{:02}", number); }
    static Creator creator(const std::string& name) {
        return {.name = name, .may_see = [name](const std::string& owner) { return owner == name; }};
    }

    SessionRegistry registry{Limits{.sessions = 8}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
};

TEST_F(FullRegistry, NamesIdleSessionsThatTheCallerMayDeleteAndCountsTheOthers) {
    v1::SessionDescription description;
    description.set_name("dam \"break\"");
    registry.create(id_of(1), test::settings(), creator("ada"), {.description = description});
    const auto busy = registry.create(id_of(2), test::settings(), creator("ada")).session;
    const auto upload = test::open_upload(*busy);
    for (int i = 3; i <= 8; ++i) registry.create(id_of(i), test::settings(), creator("ben"));
    const std::string text = refusal(creator("ada"));
    EXPECT_NE(text.find("8 sessions are open; the server holds at most 8; you may delete, of those without a stream, "
                        "\"dam \\\"break\\\"\" " +
                        id_of(1) + " (for 0 s); others: 7"),
              std::string::npos)
        << text;
    for (int i = 2; i <= 8; ++i) EXPECT_EQ(text.find(id_of(i)), std::string::npos) << text;
    EXPECT_NE(refusal(creator("eve")).find("none of them is idle and may be deleted by you"), std::string::npos);
    busy->end_upload(upload, nullptr);
}

TEST_F(FullRegistry, NamesNoMoreThanFitIntoAStatus) {
    v1::SessionDescription description;
    for (int i = 0; i < 64; ++i) description.mutable_name()->append("\U0001F30A");
    for (int i = 1; i <= 8; ++i) registry.create(id_of(i), test::settings(), {}, {.description = description});
    const std::string text = refusal({});
    EXPECT_NE(text.find("; others: 3"), std::string::npos) << text;
    EXPECT_LT(3 * text.size(), 8192U);
}

}  // namespace
}  // namespace meniscus::server
