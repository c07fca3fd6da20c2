#include "sessions/limits/name_account.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace meniscus::server {
namespace {

using std::chrono::milliseconds;

const FrameRate::Clock::time_point start = FrameRate::Clock::time_point{} + std::chrono::hours(1);
const NameShares shares{.frames_per_second = 5};

/// The number of frames that sessions of one name begin, if each is created, sends frames, and is deleted.
int frames_begun(NameAccounts& accounts, FrameRate::Clock::time_point now) {
    int begun = 0;
    for (int session = 0; session < 20; ++session)
        while (accounts.of("ada", shares, now)->take_frame(now)) ++begun;
    return begun;
}

TEST(NameAccounts, HaveNoMoreFramesForANameThatComesAgain) {
    NameAccounts accounts;
    EXPECT_EQ(frames_begun(accounts, start), 5);
    EXPECT_EQ(frames_begun(accounts, start + milliseconds(410)), 2);
    EXPECT_EQ(frames_begun(accounts, start + std::chrono::seconds(2)), 5);
}

TEST(NameAccounts, OfOthersAreKeptApart) {
    NameAccounts accounts;
    EXPECT_EQ(frames_begun(accounts, start), 5);
    EXPECT_TRUE(accounts.of("ben", shares, start)->take_frame(start));
}

TEST(NameAccounts, AreForgottenASecondAfterTheirLastUse) {
    NameAccounts accounts;
    const std::weak_ptr<NameAccount> looked = accounts.of("ada", shares, start);
    auto used = accounts.of("ben", shares, start);
    EXPECT_TRUE(looked.expired()) << "it has begun no frame";
    EXPECT_TRUE(used->take_frame(start));
    const std::weak_ptr<NameAccount> left = used;
    accounts.of("eve", shares, start);
    EXPECT_EQ(accounts.of("ben", shares, start), used) << "somebody has it";
    used.reset();
    accounts.of("eve", shares, start + milliseconds(100));
    EXPECT_FALSE(left.expired());
    accounts.of("eve", shares, start + std::chrono::seconds(1));
    EXPECT_TRUE(left.expired());
}

TEST(NameAccounts, WithoutALimitOfFramesAreForgottenAtOnce) {
    NameAccounts accounts;
    const std::weak_ptr<NameAccount> left = accounts.of("ada", {}, start);
    EXPECT_TRUE(left.lock()->take_frame(start));
    accounts.of("ben", {}, start);
    EXPECT_TRUE(left.expired());
}

}  // namespace
}  // namespace meniscus::server
