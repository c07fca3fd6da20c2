#include "sessions/handover/turns.hpp"

#include <gtest/gtest.h>

#include <stop_token>
#include <thread>
#include <vector>

namespace meniscus::server {
namespace {

TEST(Turns, GoToWhoAskedFirst) {
    Turns turns;
    std::vector<int> order;  // written in a turn only
    auto held = turns.wait({});
    std::vector<std::thread> askers;
    askers.reserve(4);
    for (int asker = 0; asker < 4; ++asker) {
        askers.emplace_back([&, asker] {
            const auto turn = turns.wait({});
            order.push_back(asker);
        });
        while (turns.waiting() != static_cast<std::uint64_t>(asker) + 1) std::this_thread::yield();
    }
    held.reset();
    for (std::thread& asker : askers) asker.join();
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
}

TEST(Turns, GoRoundAmongThoseWhoAskAgainAndAgain) {
    Turns turns;
    std::vector<int> order;
    constexpr int rounds = 20;
    auto held = turns.wait({});
    const auto ask = [&](int asker) {
        for (int round = 0; round < rounds; ++round) {
            const auto turn = turns.wait({});
            order.push_back(asker);
            // The other one has asked again: now it is a matter of order alone.
            while (turns.waiting() == 0 && order.size() < 2 * rounds - 1) std::this_thread::yield();
        }
    };
    std::thread first(ask, 0);
    std::thread second(ask, 1);
    while (turns.waiting() != 2) std::this_thread::yield();
    held.reset();
    first.join();
    second.join();
    for (std::size_t i = 1; i < order.size(); ++i) EXPECT_NE(order[i], order[i - 1]) << i;
}

TEST(Turns, AreGivenAtOnceToWhoIsAlone) {
    Turns turns;
    for (int i = 0; i < 3; ++i) const auto turn = turns.wait({});
    EXPECT_EQ(turns.waiting(), 0U);
}

TEST(Turns, AddUpToTheTimeThatTheyTook) {
    Turns turns;
    EXPECT_EQ(turns.taken().count(), 0.0);
    std::chrono::duration<double> running{};
    {
        const auto turn = turns.wait({});
        while (running.count() == 0.0) running = turns.taken();
    }
    const auto ended = turns.taken();
    EXPECT_GE(ended, running);
    EXPECT_EQ(turns.taken(), ended) << "nobody has a turn";
    { const auto turn = turns.wait({}); }
    EXPECT_GT(turns.taken(), ended);
}

TEST(Turns, AreGivenUpByWhoStopsAndGoToTheNext) {
    Turns turns;
    auto held = turns.wait({});
    std::stop_source stop;
    bool given_up = false;
    std::thread stopped([&] { given_up = !turns.wait(stop.get_token()); });
    while (turns.waiting() != 1) std::this_thread::yield();
    bool turn = false;
    std::thread next([&] { turn = turns.wait({}).has_value(); });
    while (turns.waiting() != 2) std::this_thread::yield();
    stop.request_stop();
    stopped.join();
    EXPECT_TRUE(given_up) << "while another one still has its turn";
    EXPECT_EQ(turns.waiting(), 1U);
    held.reset();
    next.join();
    EXPECT_TRUE(turn);
    EXPECT_FALSE(turns.wait(stop.get_token())) << "also where nobody else wants it";
}

}  // namespace
}  // namespace meniscus::server
