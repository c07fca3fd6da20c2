// Threads that stand for the processes of one surface.
#pragma once

#include <cstddef>
#include <thread>
#include <utility>
#include <vector>

#include "barrier.hpp"
#include "meniscus/parts.hpp"

namespace meniscus::test {

/// The place where threads that stand for processes exchange.
class Meeting {
public:
    explicit Meeting(std::size_t ranks) : barrier_(ranks), given_(ranks) {}
    std::size_t ranks() const { return given_.size(); }
    /// Gives what one has for each of the others; returns what each has for this one.
    std::vector<PartExchange::Bytes> exchange(std::size_t rank, std::vector<PartExchange::Bytes> to) {
        given_[rank] = std::move(to);
        barrier_.arrive_and_wait();
        std::vector<PartExchange::Bytes> from;
        for (const auto& its : given_) from.push_back(its[rank]);
        barrier_.arrive_and_wait();
        return from;
    }

private:
    Barrier barrier_;
    std::vector<std::vector<PartExchange::Bytes>> given_;
};

class ThreadExchange final : public PartExchange {
public:
    ThreadExchange(Meeting& meeting, std::size_t rank) : meeting_(meeting), rank_(rank) {}
    std::size_t rank() const override { return rank_; }
    std::size_t ranks() const override { return meeting_.ranks(); }
    std::vector<Bytes> gather(Bytes mine) override {
        return meeting_.exchange(rank_, std::vector<Bytes>(ranks(), mine));
    }
    std::vector<Bytes> all_to_all(std::vector<Bytes> to) override { return meeting_.exchange(rank_, std::move(to)); }

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
