#include "sessions/handover/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace meniscus::server {
namespace {

/// Threads that ask one after the other while "ada" has a turn, and the order of their turns.
struct Askers {
    ~Askers() {
        held.reset();
        for (std::thread& each : threads) each.join();
    }
    void ask(const std::string& name, const std::string& session) {
        const std::uint64_t before = turns.waiting();
        threads.emplace_back([this, name, session] {
            const auto turn = turns.wait(stop.get_token(), name, session);
            if (turn) order.push_back(turns.holder());
        });
        while (turns.waiting() == before) std::this_thread::yield();
    }
    std::vector<std::string> ordered() {
        held.reset();
        for (std::thread& each : threads) each.join();
        threads.clear();
        return order;
    }

    Turns turns;
    std::stop_source stop;
    std::optional<Turns::Turn> held = turns.wait({}, "ada");
    std::vector<std::string> order;  ///< written in a turn only
    std::vector<std::thread> threads;
};

using Sessions = std::vector<std::string>;

TEST(Turns, GoToTheSessionOfANameThatAskedFirst) {
    Askers askers;
    for (const char* session : {"1", "2", "3", "4"}) askers.ask("ada", session);
    EXPECT_EQ(askers.ordered(), (Sessions{"1", "2", "3", "4"}));
}

TEST(Turns, GoToTheNameThatAskedFirst) {
    Askers askers;
    for (const char* name : {"ben", "eve", "dan"}) askers.ask(name, name);
    EXPECT_EQ(askers.ordered(), (Sessions{"ben", "eve", "dan"}));
}

TEST(Turns, GoRoundAmongNamesHoweverManySessionsEachHas) {
    Askers askers;
    for (const char* session : {"ada 1", "ada 2", "ada 3", "ada 4"}) askers.ask("ada", session);
    askers.ask("ben", "ben 1");
    askers.ask("ben", "ben 2");
    askers.ask("eve", "eve 1");
    EXPECT_EQ(askers.ordered(), (Sessions{"ben 1", "eve 1", "ada 1", "ben 2", "ada 2", "ada 3", "ada 4"}))
        << "ada has a turn when the others come";
}

TEST(Turns, OfANameThatGivesUpGoToTheNext) {
    Askers askers;
    askers.ask("ada", "ada 1");
    askers.ask("ben", "ben 1");
    std::stop_source leaving;
    std::thread left([&] { EXPECT_FALSE(askers.turns.wait(leaving.get_token(), "eve")); });
    while (askers.turns.waiting() != 3) std::this_thread::yield();
    askers.ask("dan", "dan 1");
    leaving.request_stop();
    left.join();
    EXPECT_EQ(askers.turns.waiting(), 3U);
    EXPECT_EQ(askers.ordered(), (Sessions{"ben 1", "dan 1", "ada 1"}));
}

TEST(Turns, AreGivenUpByAllAtOnceAndGivenAgain) {
    Askers askers;
    for (const char* name : {"ada", "ben", "ada", "ben"}) askers.ask(name, name);
    askers.stop.request_stop();
    for (std::thread& each : askers.threads) each.join();
    askers.threads.clear();
    EXPECT_EQ(askers.turns.waiting(), 0U);
    askers.held.reset();
    EXPECT_TRUE(askers.turns.wait({}, "ben"));
    EXPECT_TRUE(askers.order.empty());
}

TEST(Turns, GoRoundAmongThoseWhoAskAgainAndAgain) {
    Turns turns;
    std::vector<int> order;
    constexpr int rounds = 20;
    auto held = turns.wait({}, "ada");
    const auto ask = [&](int asker) {
        for (int round = 0; round < rounds; ++round) {
            const auto turn = turns.wait({}, asker == 0 ? "ada" : "ben");
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
    for (int i = 0; i < 3; ++i) const auto turn = turns.wait({}, "ada");
    EXPECT_EQ(turns.waiting(), 0U);
}

TEST(Turns, AddUpToTheTimeThatTheyTook) {
    Turns turns;
    EXPECT_EQ(turns.taken().count(), 0.0);
    std::chrono::duration<double> running{};
    {
        const auto turn = turns.wait({}, "ada");
        while (running.count() == 0.0) running = turns.taken();
    }
    const auto ended = turns.taken();
    EXPECT_GE(ended, running);
    EXPECT_EQ(turns.taken(), ended) << "nobody has a turn";
    { const auto turn = turns.wait({}, "ada"); }
    EXPECT_GT(turns.taken(), ended);
}

TEST(LongTurns, AreOverForThoseWhoWaitAndEndOnTheirOwnLater) {
    Turns turns(Turns::Clock::duration::zero());
    std::optional<Turns::Turn> first = turns.wait({}, "ada", "1");
    std::optional<Turns::Turn> second = turns.wait({}, "ben", "2");
    EXPECT_EQ(turns.holder(), "2");
    std::optional<Turns::Turn> third = turns.wait({}, "dan", "3");
    EXPECT_EQ(turns.holder(), "3");
    first.reset();
    second.reset();
    EXPECT_EQ(turns.holder(), "3") << "the end of one that was over ends no other";
    third.reset();
    EXPECT_EQ(turns.holder(), "");
    EXPECT_TRUE(turns.wait({}, "eve"));
}

TEST(LongTurns, AreNotOverForAnotherSessionOfTheirName) {
    Turns turns(Turns::Clock::duration::zero());
    std::optional<Turns::Turn> long_one = turns.wait({}, "ada", "ada 1");
    std::thread second([&] { EXPECT_TRUE(turns.wait({}, "ada", "ada 2")->leads()); });
    while (turns.waiting() != 1) std::this_thread::yield();
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(turns.wait({}, "ben")) << "others pass by";
    EXPECT_EQ(turns.waiting(), 1U);
    long_one.reset();
    second.join();
}

/// Of eight that ask at once, and keep their turns.
TEST(LongTurns, LastForAsLongAsTheyMayAndForLittleOnceTheNextOneHasWaitedAsLong) {
    constexpr std::size_t askers = 8;
    constexpr auto longest = std::chrono::milliseconds(400);
    Turns turns(longest);
    const auto began = Turns::Clock::now();
    std::vector<Turns::Clock::duration> begun(askers);
    const auto held = turns.wait({}, "ada");
    std::vector<std::thread> threads;
    std::vector<std::optional<Turns::Turn>> kept(askers);
    for (std::size_t i = 0; i < askers; ++i)
        threads.emplace_back([&, i] {
            kept[i].emplace(*turns.wait({}, std::to_string(i)));
            begun[i] = Turns::Clock::now() - began;
        });
    for (std::thread& each : threads) each.join();
    std::ranges::sort(begun);
    for (std::size_t i = 0; i < askers; ++i) EXPECT_GE(begun[i], longest + i * longest / 32) << i;
    EXPECT_LT(begun.back(), 3 * longest) << "one after the other it would be eight times as long";
}

TEST(LongTurns, AreOverForWhoComesNextWhereTheOneInFrontGivesUp) {
    Turns turns(std::chrono::milliseconds(20));
    const auto held = turns.wait({}, "ada");
    std::stop_source leaving;
    std::thread left([&] { static_cast<void>(turns.wait(leaving.get_token(), "eve")); });
    while (turns.waiting() != 1) std::this_thread::yield();
    std::thread next([&] { EXPECT_TRUE(turns.wait({}, "ben")); });
    leaving.request_stop();
    left.join();
    next.join();
    EXPECT_EQ(turns.waiting(), 0U);
}

TEST(LongTurns, HaveOneAmongThemThatLeadsUntilItsEnd) {
    Turns turns(Turns::Clock::duration::zero());
    std::optional<Turns::Turn> first = turns.wait({}, "ada");
    std::optional<Turns::Turn> second = turns.wait({}, "ben");
    EXPECT_TRUE(first->leads());
    EXPECT_FALSE(second->leads());
    first.reset();
    std::optional<Turns::Turn> third = turns.wait({}, "eve");
    EXPECT_FALSE(second->leads());
    EXPECT_TRUE(third->leads()) << "it is the first to begin while none leads";
    second.reset();
    EXPECT_FALSE(turns.wait({}, "ben")->leads());
}

TEST(LongTurns, PassByWhoNeedsToLeadWhileAnotherOneDoes) {
    Turns turns(Turns::Clock::duration::zero());
    std::optional<Turns::Turn> first = turns.wait({}, "ada");
    std::optional<Turns::Turn> led;
    std::thread needs_to_lead([&] { led.emplace(*turns.wait({}, "ben", "ben 1", Turns::Needs::to_lead)); });
    while (turns.waiting() != 1) std::this_thread::yield();
    for (const char* name : {"ben", "eve"}) EXPECT_FALSE(turns.wait({}, name)->leads()) << name;
    EXPECT_EQ(turns.waiting(), 1U);
    first.reset();
    needs_to_lead.join();
    EXPECT_TRUE(led->leads());
    EXPECT_EQ(turns.holder(), "ben 1");
}

TEST(LongTurns, OfWhoNeedsToLeadComeBeforeThoseWhoAskedLater) {
    // The others' turns are longer than this test: each waits for the end of the one before it.
    Turns turns(std::chrono::minutes(10));
    std::optional<Turns::Turn> first = turns.wait({}, "ada");
    std::vector<std::string> order;
    std::vector<std::thread> threads;
    const auto ask = [&](const std::string& name, Turns::Needs needs) {
        const std::uint64_t before = turns.waiting();
        threads.emplace_back([&, name, needs] {
            const auto turn = turns.wait({}, name, name, needs);
            order.push_back(name);
        });
        while (turns.waiting() == before) std::this_thread::yield();
    };
    ask("ben", Turns::Needs::to_lead);
    ask("eve", Turns::Needs::any_turn);
    first.reset();
    for (std::thread& each : threads) each.join();
    EXPECT_EQ(order, (std::vector<std::string>{"ben", "eve"}));
}

TEST(Turns, EachLeadWhereNoneIsOverBeforeItsEnd) {
    Turns turns;
    for (const auto needs : {Turns::Needs::any_turn, Turns::Needs::to_lead})
        EXPECT_TRUE(turns.wait({}, "ada", {}, needs)->leads());
}

/// Many threads that ask again and again, and keep some of their turns for longer than they may: each has all of its
/// turns, and one leads at a time.
TEST(LongTurns, GoRoundAmongMany) {
    Turns turns(std::chrono::microseconds(50));
    std::atomic<int> had{0};
    std::atomic<int> leaders{0};
    std::vector<std::thread> threads;
    for (unsigned asker = 0; asker < 6; ++asker)
        threads.emplace_back([&, asker] {
            std::mt19937 random(asker);
            for (int round = 0; round < 200; ++round) {
                std::stop_source stop;
                if (random() % 8 == 0) stop.request_stop();
                const auto needs = random() % 4 == 0 ? Turns::Needs::to_lead : Turns::Needs::any_turn;
                const auto turn = turns.wait(stop.get_token(), std::to_string(asker / 2), {}, needs);
                EXPECT_EQ(turn.has_value(), !stop.stop_requested());
                const bool leads = turn && turn->leads();
                EXPECT_TRUE(leads || !turn || needs == Turns::Needs::any_turn);
                EXPECT_LE(leaders.fetch_add(leads), leads ? 0 : 1);
                ++had;
                if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 200));
                if (leads) --leaders;
            }
        });
    for (std::thread& each : threads) each.join();
    EXPECT_EQ(had, 6 * 200);
    EXPECT_EQ(turns.waiting(), 0U);
    EXPECT_EQ(turns.holder(), "");
}

TEST(Turns, AreGivenUpByWhoStopsAndGoToTheNext) {
    Turns turns;
    auto held = turns.wait({}, "ada");
    std::stop_source stop;
    bool given_up = false;
    std::thread stopped([&] { given_up = !turns.wait(stop.get_token(), "ada"); });
    while (turns.waiting() != 1) std::this_thread::yield();
    bool turn = false;
    std::thread next([&] { turn = turns.wait({}, "ada").has_value(); });
    while (turns.waiting() != 2) std::this_thread::yield();
    stop.request_stop();
    stopped.join();
    EXPECT_TRUE(given_up) << "while another one still has its turn";
    EXPECT_EQ(turns.waiting(), 1U);
    held.reset();
    next.join();
    EXPECT_TRUE(turn);
    EXPECT_FALSE(turns.wait(stop.get_token(), "ada")) << "also where nobody else wants it";
}

}  // namespace
}  // namespace meniscus::server
