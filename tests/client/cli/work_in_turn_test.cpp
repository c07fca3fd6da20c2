// Several frames at a time with the outcome of one after the other, how many, and what is shown of it.
#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/print/progress_bar.hpp"
#include "cli/sequence/jobs.hpp"
#include "cli/sequence/work_in_turn.hpp"

namespace meniscus::cli {
namespace {

std::vector<Work> workers(std::size_t count, const Work& work) {
    return std::vector<Work>(count, work);
}

TEST(WorkInTurn, IsSeenInOrderThoughTheFirstComeLast) {
    // All four are under way before any is done: the later ones have to wait.
    std::barrier all_there(4);
    std::vector<std::size_t> seen;
    work_in_turn(8, workers(4, [&](std::size_t item, const std::function<void()>& wait_for_turn) {
                     all_there.arrive_and_wait();
                     wait_for_turn();
                     seen.push_back(item);
                 }));
    EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(WorkInTurn, ThrowsTheFirstErrorInOrderAndShowsNothingOfWhatFollows) {
    for (const std::size_t count : {1U, 2U, 4U}) {
        std::atomic<bool> later_failed = false;
        std::vector<std::size_t> seen;
        std::string thrown;
        try {
            work_in_turn(20, workers(count, [&](std::size_t item, const std::function<void()>& wait_for_turn) {
                             if (item == 4) {
                                 later_failed = true;
                                 later_failed.notify_all();
                                 throw std::runtime_error("4");
                             }
                             if (item == 3) {  // fails after 4 has, where somebody works on that
                                 if (count > 1) later_failed.wait(false);
                                 throw std::runtime_error("3");
                             }
                             wait_for_turn();
                             seen.push_back(item);
                         }));
        } catch (const std::runtime_error& error) {
            thrown = error.what();
        }
        EXPECT_EQ(thrown, "3") << count;
        EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2})) << count;
    }
}

TEST(WorkInTurn, OfNothingIsDone) {
    work_in_turn(0, workers(3, [](std::size_t, const std::function<void()>&) { FAIL(); }));
}

TEST(Jobs, AreAsManyAsThereAreThreadsFramesAndMemoryFor) {
    const JobsInput small{.frames = 100, .threads = 4, .file_bytes = 1 << 20, .memory_bytes = 16ULL << 30};
    EXPECT_EQ(jobs_of(small, std::nullopt), 4U);
    EXPECT_EQ(jobs_of(small, 3), 3U);
    EXPECT_EQ(jobs_of({.frames = 2, .threads = 4, .file_bytes = 1 << 20, .memory_bytes = 16ULL << 30}, 3), 2U);
    EXPECT_EQ(jobs_of({.frames = 100, .threads = 64, .file_bytes = 1 << 20, .memory_bytes = 64ULL << 30}, std::nullopt),
              8U);
    // Half of 16 GiB takes the 200-fold of 40 MiB once.
    EXPECT_EQ(jobs_of({.frames = 9, .threads = 4, .file_bytes = 40 << 20, .memory_bytes = 16ULL << 30}, std::nullopt),
              1U);
    EXPECT_EQ(jobs_of({.frames = 9, .threads = 4, .file_bytes = 1ULL << 40, .memory_bytes = 1}, std::nullopt), 1U);
    EXPECT_EQ(jobs_of({.frames = 0, .threads = 4, .file_bytes = 0, .memory_bytes = 0}, std::nullopt), 1U);
}

TEST(ProgressLine, ShowsFramesAndSecondsWithinTheTerminal) {
    EXPECT_EQ(progress_line(0, 60, 3.0, 80), "0 of 60 frames  [                              ]");
    EXPECT_EQ(progress_line(20, 60, 10.0, 80), "20 of 60 frames  [==========                    ]  20 s left");
    EXPECT_EQ(progress_line(60, 60, 30.0, 80), "60 of 60 frames  [==============================]  0 s left");
    for (std::size_t columns = 0; columns < 90; ++columns)
        EXPECT_LE(progress_line(20, 60, 10.0, columns).size(), columns == 0 ? 0 : columns - 1);
}

}  // namespace
}  // namespace meniscus::cli
