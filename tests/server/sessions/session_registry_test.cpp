#include "sessions/session_registry.hpp"

#include <gtest/gtest.h>

#include "meniscus/error.hpp"
#include "sessions/refusal.hpp"
#include "test_frames.hpp"

namespace meniscus::server {
namespace {

constexpr const char* first_id = "00000000-0000-4000-8000-000000000001";
constexpr const char* second_id = "00000000-0000-4000-8000-000000000002";
constexpr const char* third_id = "00000000-0000-4000-8000-000000000003";

struct Registry : testing::Test {
    SessionRegistry registry{Limits{.sessions = 2}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
};

TEST_F(Registry, JoinsASessionWithEqualSettings) {
    EXPECT_EQ(registry.create(first_id, test::settings()), registry.create(first_id, test::settings()));
    EXPECT_EQ(registry.list().size(), 1U);
}

TEST_F(Registry, RefusesOtherSettingsUnderTheSameId) {
    registry.create(first_id, test::settings());
    Settings other = test::settings();
    other.iso = 0.5;
    try {
        registry.create(first_id, other);
        FAIL();
    } catch (const Refusal& refusal) {
        EXPECT_EQ(refusal.kind(), Refusal::Kind::already_exists);
    }
}

TEST_F(Registry, RefusesSessionsPastTheLimitUntilOneIsRemoved) {
    const auto first = registry.create(first_id, test::settings());
    registry.create(second_id, test::settings());
    EXPECT_THROW(registry.create(third_id, test::settings()), LimitExceeded);
    EXPECT_NO_THROW(registry.create(second_id, test::settings()));
    registry.remove(first);
    EXPECT_NO_THROW(registry.create(third_id, test::settings()));
}

TEST_F(Registry, ListsSessionsInTheOrderOfTheirIds) {
    registry.create(second_id, test::settings());
    registry.create(first_id, test::settings());
    EXPECT_EQ(registry.list()[0]->id(), first_id);
    EXPECT_EQ(registry.list()[1]->id(), second_id);
}

TEST_F(Registry, KnowsNoSessionThatWasRemoved) {
    const auto first = registry.create(first_id, test::settings());
    registry.remove(first);
    EXPECT_THROW(registry.find(first_id), Refusal);
    EXPECT_THROW(registry.remove(first), Refusal);
}

TEST_F(Registry, RemovesTheSessionThatWasMeantAndNotItsSuccessorOfTheSameId) {
    const auto first = registry.create(first_id, test::settings());
    registry.remove(first);
    const auto successor = registry.create(first_id, test::settings());
    EXPECT_THROW(registry.remove(first), Refusal);
    EXPECT_EQ(registry.find(first_id), successor);
}

TEST_F(Registry, ForgetsASessionThatEndedByItself) {
    const auto ended = registry.create(first_id, test::settings());
    registry.create(second_id, test::settings());
    ended->close();
    EXPECT_THROW(registry.find(first_id), Refusal);
    EXPECT_EQ(registry.list().size(), 1U);
    EXPECT_NE(registry.create(first_id, test::settings()), ended);
}

TEST_F(Registry, TakesNoSessionsWhileItDrains) {
    const auto session = registry.create(first_id, test::settings());
    registry.drain(std::chrono::seconds(1));
    EXPECT_THROW(registry.create(second_id, test::settings()), Refusal);
    EXPECT_THROW(session->open_upload(
                     {}, [] {}, [] {}),
                 Refusal);
}

TEST(IdleRegistry, ForgetsASessionThatNobodyHasUsedForAsLongAsTheLimitSaysAndNoneBefore) {
    using Clock = std::chrono::steady_clock;
    constexpr auto limit = std::chrono::hours(1);
    SessionRegistry registry{Limits{.idle_time = limit}, BackendOptions{.backend = Backend::cpu, .threads = 1}, 1};
    const auto before = Clock::now();
    const auto used = registry.create(first_id, test::settings());
    const auto upload = used->open_upload(
        {}, [] {}, [] {});
    registry.create(second_id, test::settings());
    const auto after = Clock::now();
    registry.end_idle(before + limit - std::chrono::milliseconds(1));
    EXPECT_EQ(registry.list().size(), 2U);
    registry.end_idle(after + limit);
    ASSERT_EQ(registry.list().size(), 1U);
    EXPECT_EQ(registry.list()[0], used);
    const auto end = std::get<OutputQueue::End>(upload->output.take());
    EXPECT_THROW(std::rethrow_exception(end.error), LimitExceeded);
}

TEST_F(Registry, RefusesSettingsOutOfRange) {
    EXPECT_THROW(registry.create(first_id, Settings{}), InvalidInput);
    EXPECT_TRUE(registry.list().empty());
}

}  // namespace
}  // namespace meniscus::server
