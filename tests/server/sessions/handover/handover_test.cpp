// The pieces through which frames pass from thread to thread.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <future>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

#include "sessions/handover/channel.hpp"
#include "sessions/handover/slot_pool.hpp"
#include "sessions/sending/output_queue.hpp"

namespace meniscus::server {
namespace {

SharedMessage message(const std::string& text) {
    return std::make_shared<const std::string>(text);
}

TEST(Channel, KeepsTheOrderAcrossThreads) {
    Channel<int> channel;
    std::thread producer([&] {
        for (int i = 0; i < 1000; ++i) channel.put(i);
    });
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(channel.take(), i);
    producer.join();
}

TEST(Channel, EndsAWaitingTakeWhenClosed) {
    Channel<int> channel;
    auto taken = std::async(std::launch::async, [&] { return channel.take(); });
    channel.close();
    EXPECT_EQ(taken.get(), std::nullopt);
    channel.put(1);
    EXPECT_EQ(channel.take(), std::nullopt);
}

TEST(SlotPool, LendsASlotToWhoAskedFirst) {
    SlotPool<int> pool;
    int slot = 0;
    std::vector<int> order;
    pool.request([&](int&) {
        order.push_back(1);
        return true;
    });
    pool.request([&](int&) {
        order.push_back(2);
        return true;
    });
    pool.give(slot);
    EXPECT_EQ(order, (std::vector<int>{1}));
    pool.give(slot);
    EXPECT_EQ(order, (std::vector<int>{1, 2}));
}

TEST(SlotPool, OffersADeclinedSlotToTheNext) {
    SlotPool<int> pool;
    int slot = 0;
    int* taken = nullptr;
    pool.request([](int&) { return false; });
    pool.request([&](int& s) {
        taken = &s;
        return true;
    });
    pool.give(slot);
    EXPECT_EQ(taken, &slot);
}

// Asserts that neither waiter is called: each would fail the test.
TEST(SlotPool, ForgetsWhoWaitsWhenClosed) {
    SlotPool<int> pool;
    int slot = 0;
    pool.request([](int&) {
        ADD_FAILURE();
        return true;
    });
    pool.close();
    pool.give(slot);
    pool.request([](int&) {
        ADD_FAILURE();
        return true;
    });
}

TEST(SlotPool, NeverLendsASlotTwice) {
    SlotPool<std::atomic<int>> pool;
    std::array<std::atomic<int>, 2> slots{};
    for (auto& slot : slots) pool.give(slot);
    constexpr std::ptrdiff_t rounds = 500;
    constexpr std::ptrdiff_t borrower_count = 4;
    std::latch done(borrower_count * rounds);
    std::vector<std::thread> borrowers;
    borrowers.reserve(borrower_count);
    for (std::ptrdiff_t borrower = 0; borrower < borrower_count; ++borrower)
        borrowers.emplace_back([&] {
            for (std::ptrdiff_t round = 0; round < rounds; ++round) {
                std::promise<std::atomic<int>*> lent;
                pool.request([&](std::atomic<int>& slot) {
                    lent.set_value(&slot);
                    return true;
                });
                std::atomic<int>& slot = *lent.get_future().get();
                EXPECT_EQ(slot.fetch_add(1), 0);
                slot.fetch_sub(1);
                pool.give(slot);
                done.count_down();
            }
        });
    done.wait();
    for (std::thread& borrower : borrowers) borrower.join();
}

TEST(OutputQueue, GivesEveryMessageInOrderThenTheEnd) {
    OutputQueue queue([](std::size_t /*reader*/) {});
    queue.push(message("a"));
    queue.push(message("b"));
    queue.finish(nullptr);
    queue.push(message("too late"));
    EXPECT_EQ(*std::get<SharedMessage>(queue.take()), "a");
    EXPECT_EQ(*std::get<SharedMessage>(queue.take()), "b");
    EXPECT_EQ(std::get<OutputQueue::End>(queue.take()).error, nullptr);
}

TEST(OutputQueue, WakesAWaitingConsumerOnce) {
    int woken = 0;
    OutputQueue queue([&](std::size_t /*reader*/) { ++woken; });
    queue.push(message("a"));
    EXPECT_EQ(woken, 0);
    queue.take();
    EXPECT_TRUE(std::holds_alternative<OutputQueue::Nothing>(queue.take()));
    queue.push(message("b"));
    queue.push(message("c"));
    EXPECT_EQ(woken, 1);
}

TEST(OutputQueue, HoldsTheNextFrameBackUntilTheConsumerTookEnough) {
    OutputQueue queue([](std::size_t /*reader*/) {});
    for (std::size_t i = 0; i < OutputQueue::room_for_a_frame + 1; ++i) queue.push(message("m"));
    auto room = std::async(std::launch::async, [&] { return queue.wait_for_room(); });
    queue.take();
    EXPECT_TRUE(room.get());
}

TEST(OutputQueue, ReleasesAWaitingProducerWhenTheConsumerIsGone) {
    OutputQueue queue([](std::size_t /*reader*/) {});
    for (std::size_t i = 0; i < OutputQueue::room_for_a_frame + 1; ++i) queue.push(message("m"));
    auto room = std::async(std::launch::async, [&] { return queue.wait_for_room(); });
    queue.close();
    EXPECT_FALSE(room.get());
}

TEST(OutputQueue, DropsWhatWaitsWhenAborted) {
    OutputQueue queue([](std::size_t /*reader*/) {});
    for (std::size_t i = 0; i < OutputQueue::room_for_a_frame + 1; ++i) queue.push(message("m"));
    auto room = std::async(std::launch::async, [&] { return queue.wait_for_room(); });
    queue.abort(std::make_exception_ptr(std::runtime_error("gone")));
    EXPECT_FALSE(room.get());
    EXPECT_NE(std::get<OutputQueue::End>(queue.take()).error, nullptr);
}

TEST(OutputQueue, TellsOfWhatAnAbortDropsAlsoOnceItHasFinished) {
    for (const bool is_taken : {false, true}) {
        int woken = 0;
        OutputQueue queue([&](std::size_t /*reader*/) { ++woken; });
        queue.push(message("the last"));
        queue.finish(nullptr);
        if (is_taken) queue.take();
        queue.abort(std::make_exception_ptr(std::runtime_error("gone")));
        EXPECT_EQ(queue.aborted(), !is_taken);
        EXPECT_EQ(woken, is_taken ? 0 : 1);
        EXPECT_EQ(std::get<OutputQueue::End>(queue.take()).error == nullptr, is_taken);
    }
}

TEST(OutputQueue, KeepsTheErrorThatItHasFinishedWithWhenAborted) {
    const auto refused = std::make_exception_ptr(std::runtime_error("refused"));
    OutputQueue queue([](std::size_t /*reader*/) {});
    queue.push(message("the last"));
    queue.finish(refused);
    queue.abort(std::make_exception_ptr(std::runtime_error("gone")));
    EXPECT_TRUE(queue.aborted());
    EXPECT_EQ(std::get<OutputQueue::End>(queue.take()).error, refused);
}

TEST(OutputQueue, IsAbortedUnlessItHasFinished) {
    const auto gone = std::make_exception_ptr(std::runtime_error("gone"));
    OutputQueue queue([](std::size_t /*reader*/) {});
    queue.push(message("the last"));
    queue.finish(nullptr);
    EXPECT_FALSE(queue.abort_unless_finished(gone));
    EXPECT_EQ(*std::get<SharedMessage>(queue.take()), "the last");
    EXPECT_EQ(std::get<OutputQueue::End>(queue.take()).error, nullptr);

    OutputQueue other([](std::size_t /*reader*/) {});
    other.push(message("dropped"));
    EXPECT_TRUE(other.abort_unless_finished(gone));
    EXPECT_EQ(std::get<OutputQueue::End>(other.take()).error, gone);
    EXPECT_FALSE(other.abort_unless_finished(gone)) << "it has ended";
}

}  // namespace
}  // namespace meniscus::server
