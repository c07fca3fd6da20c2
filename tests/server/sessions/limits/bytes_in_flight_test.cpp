#include "sessions/limits/bytes_in_flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "meniscus/error.hpp"
#include "sessions/limits/frame_sender.hpp"

namespace meniscus::server {
namespace {

using test::Sender;

struct InFlight : testing::Test {
    // Shares of 62 bytes, and 752 in common.
    const std::shared_ptr<BytesInFlight> all = std::make_shared<BytesInFlight>(1000, 4);
};

TEST_F(InFlight, CostOthersNothingWhileTheyAreOnlyAnnounced) {
    Sender first(all);
    Sender second(all);
    for (Sender* trickler : {&first, &second}) {
        trickler->begin(1000);
        trickler->arrive(1);
    }
    EXPECT_TRUE(second.waits) << "it needs all that there is";
    for (const std::size_t bytes : {0U, 1U, 62U, 63U, 500U, 750U}) {
        Sender other(all);
        other.begin(bytes);
        EXPECT_TRUE(other.arrive(bytes)) << bytes;
        EXPECT_TRUE(other.whole()) << bytes;
    }
}

TEST_F(InFlight, AreKeptForEachSession) {
    std::array<Sender, 3> large{Sender(all), Sender(all), Sender(all)};
    for (Sender& sender : large) {
        sender.begin(700);
        while (sender.arrive(10) && !sender.whole()) {
        }
    }
    EXPECT_EQ(all->waiting(), 2U);
    Sender small(all);
    small.begin(62);
    EXPECT_TRUE(small.arrive(62));
    EXPECT_LE(all->bytes(), 1000U);
}

TEST_F(InFlight, BringTwoLargeFramesInOneAfterTheOther) {
    for (const std::size_t bytes : {600U, 814U, 815U, 900U, 1000U}) {
        Sender first(all);
        Sender second(all);
        first.begin(bytes);
        second.begin(bytes);
        while (!first.whole() && !second.whole()) {
            if (!first.waits) first.arrive(50);
            if (!second.waits) second.arrive(50);
            ASSERT_FALSE(first.waits && second.waits) << bytes;
            ASSERT_LE(all->bytes(), 1000U);
        }
        Sender& rest = first.whole() ? second : first;
        (first.whole() ? first : second).frame.release();
        EXPECT_FALSE(rest.waits) << bytes;
        while (!rest.whole()) ASSERT_TRUE(rest.arrive(50)) << bytes;
    }
    EXPECT_EQ(all->bytes(), 0U);
}

TEST_F(InFlight, AreRefusedBeforeTheFirstByteIfThereCanNeverBeAsMany) {
    Sender sender(all);
    EXPECT_NO_THROW(sender.begin(1000));
    EXPECT_THROW(sender.begin(1001), LimitExceeded);
    EXPECT_EQ(all->bytes(), 0U);
}

TEST_F(InFlight, AreForgottenWithTheFrameThatWaits) {
    Sender first(all);
    first.begin(1000);
    EXPECT_TRUE(first.arrive(1000));
    Sender second(all);
    second.begin(500);
    EXPECT_TRUE(second.waits);
    second.frame.release();
    first.frame.release();
    EXPECT_TRUE(second.waits) << "nobody is called for a frame that is gone";
    EXPECT_EQ(all->bytes(), 0U);
}

TEST_F(InFlight, OfOneNameStayBelowItsLimit) {
    const auto name = std::make_shared<NameInFlight>();
    name->limit = 300;
    const auto session_of_the_name = [&] {
        auto session = std::make_shared<SessionInFlight>();
        session->name = name;
        return session;
    };
    Sender first(all, session_of_the_name());
    Sender second(all, session_of_the_name());
    Sender other(all);
    first.begin(200);
    second.begin(101);
    other.begin(600);
    EXPECT_FALSE(first.waits);
    EXPECT_TRUE(second.waits);
    EXPECT_FALSE(other.waits);
    first.frame.release();
    EXPECT_FALSE(second.waits);
    EXPECT_THROW(first.begin(301), LimitExceeded);
}

/// Whatever is announced and arrives, in whatever order: the limit holds, and every frame arrives.
TEST(InFlightAtRandom, NeverPassTheLimitAndNeverGetStuck) {
    for (const std::uint32_t sessions : {0U, 1U, 5U}) {
        for (unsigned seed = 0; seed < 200; ++seed) {
            std::mt19937 random(seed);
            const auto up_to = [&](std::size_t most) {
                return std::uniform_int_distribution<std::size_t>(0, most)(random);
            };
            const auto all = std::make_shared<BytesInFlight>(1000, sessions);
            std::deque<Sender> senders;
            std::vector<int> frames_left;
            for (std::uint32_t i = 0; i < (sessions != 0 ? sessions : 5U); ++i) {
                const auto session = std::make_shared<SessionInFlight>();
                for (int slot = 0; slot < 2; ++slot) {
                    senders.emplace_back(all, session);
                    frames_left.push_back(10);
                    senders.back().begin(up_to(1000));
                }
            }
            for (int left = static_cast<int>(senders.size()) * 10; left > 0;) {
                const auto goes_on = [&](std::size_t i) { return frames_left[i] > 0 && !senders[i].waits; };
                std::vector<std::size_t> able;
                for (std::size_t i = 0; i < senders.size(); ++i)
                    if (goes_on(i)) able.push_back(i);
                ASSERT_FALSE(able.empty()) << "seed " << seed << ": all wait";
                const std::size_t i = able[up_to(able.size() - 1)];
                Sender& sender = senders[i];
                if (!sender.whole()) {
                    sender.arrive(1 + up_to(200));
                } else if (--left, --frames_left[i] > 0) {
                    sender.begin(up_to(1) == 0 ? up_to(100) : up_to(1000));
                } else {
                    sender.frame.release();
                }
                ASSERT_LE(all->bytes(), 1000U);
            }
            EXPECT_EQ(all->bytes(), 0U);
        }
    }
}

}  // namespace
}  // namespace meniscus::server
