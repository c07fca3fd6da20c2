// Threads that stand for the processes of one surface.
#pragma once

#include <cstddef>
#include <vector>

#include "meeting.hpp"
#include "meniscus/parts.hpp"

namespace meniscus::test {

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
            if (rank == rank_)
                from[rank].swap(to[rank]);
            else
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
    in_threads(ranks, [&](std::size_t rank) {
        ThreadExchange exchange(meeting, rank);
        act(exchange);
    });
}

}  // namespace meniscus::test
