// Threads that stand for the ranks of a job, for tests of the C interface.
#pragma once

#include <barrier>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#include "handles.hpp"

namespace meniscus::test {

class RankMeeting {
public:
    explicit RankMeeting(std::size_t ranks) : barrier_(static_cast<std::ptrdiff_t>(ranks)), said_(ranks) {}

    /// Of a rank; stays valid as long as this.
    meniscus_exchange exchange(std::uint32_t rank, bool leads_node) {
        said_[rank].meeting = this;
        said_[rank].rank = rank;
        return {sizeof(meniscus_exchange),
                rank,
                static_cast<std::uint32_t>(said_.size()),
                leads_node ? 1U : 0U,
                &said_[rank],
                gather,
                trade_sizes,
                trade,
                nullptr};
    }

private:
    struct Said {
        RankMeeting* meeting = nullptr;
        std::size_t rank = 0;
        const void* what = nullptr;
    };

    /// Calls take(rank, what) with what each rank has said.
    template <class Take>
    static int meet(void* context, const void* what, const Take& take) {
        Said& mine = *static_cast<Said*>(context);
        RankMeeting& meeting = *mine.meeting;
        mine.what = what;
        meeting.barrier_.arrive_and_wait();
        for (const Said& its : meeting.said_) take(its.rank, its.what);
        meeting.barrier_.arrive_and_wait();
        return 0;
    }
    static int gather(void* context, const void* mine, const std::size_t* sizes, void* all) {
        auto* to = static_cast<std::byte*>(all);
        return meet(context, mine, [&](std::size_t rank, const void* its) {
            if (sizes[rank] != 0) std::memcpy(to, its, sizes[rank]);
            to += sizes[rank];
        });
    }
    static int trade_sizes(void* context, const std::uint64_t* to, std::uint64_t* from) {
        const std::size_t own = static_cast<Said*>(context)->rank;
        return meet(context, to, [&](std::size_t rank, const void* its) {
            from[rank] = static_cast<const std::uint64_t*>(its)[own];
        });
    }
    static int trade(void* context, const void* const* to, const std::uint64_t* /*to_sizes*/, void* const* from,
                     const std::uint64_t* from_sizes) {
        const std::size_t own = static_cast<Said*>(context)->rank;
        return meet(context, to, [&](std::size_t rank, const void* its) {
            if (from_sizes[rank] != 0)
                std::memcpy(from[rank], static_cast<const void* const*>(its)[own], from_sizes[rank]);
        });
    }

    std::barrier<> barrier_;
    std::vector<Said> said_;
};

/// Runs act(exchange) in a thread for each rank, and waits for all. The first leads the only node.
template <class Act>
void on_ranks(std::size_t ranks, const Act& act) {
    RankMeeting meeting(ranks);
    std::vector<std::thread> threads;
    for (std::uint32_t rank = 0; rank < ranks; ++rank)
        threads.emplace_back([&, rank] { act(meeting.exchange(rank, rank == 0)); });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace meniscus::test
