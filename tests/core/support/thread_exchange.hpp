// Threads that stand for the processes of one surface.
#pragma once

#include <cstddef>
#include <thread>
#include <vector>

#include "barrier.hpp"
#include "meniscus/parts.hpp"

namespace meniscus::test {

/// The place where threads that stand for processes exchange.
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

class ThreadExchange final : public PartExchange {
public:
    ThreadExchange(Meeting& meeting, std::size_t rank) : meeting_(meeting), rank_(rank) {}
    std::size_t rank() const override { return rank_; }
    std::size_t ranks() const override { return meeting_.ranks(); }
    std::vector<Bytes> gather(Bytes mine) override {
        std::vector<Bytes> all(ranks());
        meeting_.meet(rank_, &mine,
                      [&](std::size_t rank, const void* its) { all[rank] = *static_cast<const Bytes*>(its); });
        return all;
    }
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override {
        from.resize(ranks());
        meeting_.meet(rank_, &to, [&](std::size_t rank, const void* its) {
            from[rank] = (*static_cast<const std::vector<Bytes>*>(its))[rank_];
        });
    }

private:
    Meeting& meeting_;
    std::size_t rank_;
};

/// Runs act(exchange) for each rank, and waits for all.
template <class Act>
void on_ranks(std::size_t ranks, const Act& act) {
    Meeting meeting(ranks);
    std::vector<std::thread> threads;
    for (std::size_t rank = 0; rank < ranks; ++rank)
        threads.emplace_back([&, rank] {
            ThreadExchange exchange(meeting, rank);
            act(exchange);
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace meniscus::test
