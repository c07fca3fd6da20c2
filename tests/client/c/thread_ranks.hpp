// Threads that stand for the ranks of a job, for tests of the C interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "handles.hpp"
#include "support/meeting.hpp"

namespace meniscus::test {

class RankMeeting {
public:
    explicit RankMeeting(std::size_t ranks) : meeting_(ranks), callers_(ranks) {}

    /// Of a rank; stays valid as long as this.
    meniscus_exchange exchange(std::uint32_t rank, bool leads_node) {
        callers_[rank] = {&meeting_, rank};
        return {sizeof(meniscus_exchange),
                rank,
                static_cast<std::uint32_t>(callers_.size()),
                leads_node ? 1U : 0U,
                &callers_[rank],
                gather,
                trade_sizes,
                trade,
                nullptr};
    }

private:
    struct Caller {
        Meeting* meeting = nullptr;
        std::size_t rank = 0;
    };

    template <class Read>
    static int meet(void* context, const void* what, const Read& read) {
        const Caller& caller = *static_cast<const Caller*>(context);
        caller.meeting->meet(caller.rank, what, read);
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
        const std::size_t own = static_cast<const Caller*>(context)->rank;
        return meet(context, to, [&](std::size_t rank, const void* its) {
            from[rank] = static_cast<const std::uint64_t*>(its)[own];
        });
    }
    static int trade(void* context, const void* const* to, const std::uint64_t* /*to_sizes*/, void* const* from,
                     const std::uint64_t* from_sizes) {
        const std::size_t own = static_cast<const Caller*>(context)->rank;
        return meet(context, to, [&](std::size_t rank, const void* its) {
            if (from_sizes[rank] != 0)
                std::memcpy(from[rank], static_cast<const void* const*>(its)[own], from_sizes[rank]);
        });
    }

    Meeting meeting_;
    std::vector<Caller> callers_;
};

/// Runs act(exchange) in a thread for each rank, and waits for all. The first leads the only node.
template <class Act>
void on_ranks(std::size_t ranks, const Act& act) {
    RankMeeting meeting(ranks);
    in_threads(ranks, [&](std::size_t rank) { act(meeting.exchange(static_cast<std::uint32_t>(rank), rank == 0)); });
}

}  // namespace meniscus::test
