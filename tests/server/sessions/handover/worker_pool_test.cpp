#include "sessions/handover/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

namespace meniscus::server {
namespace {

TEST(WorkerPool, CallsEveryIndexOnce) {
    WorkerPool pool(4);
    std::vector<int> calls(1000);
    pool.for_each(calls.size(), [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
}

TEST(WorkerPool, WorksWithItsCallerAlone) {
    WorkerPool pool(1);
    std::vector<std::thread::id> threads(10);
    pool.for_each(threads.size(), [&](std::size_t i) { threads[i] = std::this_thread::get_id(); });
    EXPECT_EQ(threads, std::vector<std::thread::id>(10, std::this_thread::get_id()));
}

// Asserts by not hanging: each of the three waits for the other two.
TEST(WorkerPool, RunsIndicesAtTheSameTime) {
    WorkerPool pool(3);
    std::latch together(3);
    pool.for_each(3, [&](std::size_t) { together.arrive_and_wait(); });
}

TEST(WorkerPool, ServesSeveralCallersAtTheSameTime) {
    WorkerPool pool(3);
    std::atomic<std::size_t> sum{0};
    std::vector<std::thread> callers;
    callers.reserve(4);
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back([&] {
            for (int round = 0; round < 50; ++round) pool.for_each(20, [&](std::size_t i) { sum += i; });
        });
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(sum, 4U * 50U * 190U);
}

TEST(WorkerPool, RethrowsTheFirstErrorAndRemainsUsable) {
    WorkerPool pool(3);
    EXPECT_THROW(pool.for_each(100,
                               [](std::size_t i) {
                                   if (i == 7) throw std::runtime_error("seven");
                               }),
                 std::runtime_error);
    std::atomic<int> calls{0};
    pool.for_each(10, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 10);
}

TEST(WorkerPool, DoesNothingForNoIndices) {
    WorkerPool pool(2);
    pool.for_each(0, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace meniscus::server
