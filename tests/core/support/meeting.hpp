// Threads that stand for processes, and the place where they meet.
#pragma once

#include <cstddef>
#include <thread>
#include <vector>

#include "barrier.hpp"

namespace meniscus::test {

class Meeting {
public:
    explicit Meeting(std::size_t ranks) : barrier_(ranks), shown_(ranks) {}
    std::size_t ranks() const { return shown_.size(); }
    /// Shows all what each one has; read(rank, what) gets that of each, while it stays.
    template <class Read>
    void meet(std::size_t rank, const void* mine, const Read& read) {
        shown_[rank] = mine;
        barrier_.arrive_and_wait();
        for (std::size_t other = 0; other < ranks(); ++other) read(other, shown_[other]);
        barrier_.arrive_and_wait();
    }

private:
    Barrier barrier_;
    std::vector<const void*> shown_;
};

/// Runs act(rank) in a thread for each rank, and waits for all.
template <class Act>
void in_threads(std::size_t ranks, const Act& act) {
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < ranks; ++rank) threads.emplace_back([&act, rank] { act(rank); });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace meniscus::test
