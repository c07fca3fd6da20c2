#include "rank_exchange.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <new>
#include <string>

#include "meniscus/error.hpp"
#include "result.hpp"
#include "sized_struct.hpp"

namespace meniscus::c {
namespace {

void require_success(int result, const char* function) {
    if (result != 0)
        throw ProcessFailed(std::string("exchange->") + function + " has returned " + std::to_string(result) +
                            ": the ranks can exchange no more");
}

}  // namespace

RankExchange::RankExchange(const meniscus_exchange* exchange) : to_(read_struct(exchange, "exchange")) {
    if (to_.rank >= to_.ranks)
        throw InvalidInput("exchange->rank is " + std::to_string(to_.rank) + ", must be below exchange->ranks, " +
                           std::to_string(to_.ranks));
    required(to_.gather, "exchange->gather");
    required(to_.trade_sizes, "exchange->trade_sizes");
    required(to_.trade, "exchange->trade");
}

std::vector<PartExchange::Bytes> RankExchange::gather(Bytes mine) {
    /// What is small comes in one call.
    struct Beginning {
        std::uint64_t size = 0;
        std::array<std::byte, 248> bytes{};
        std::size_t there() const { return std::min<std::size_t>(size, bytes.size()); }
    };
    Beginning own{mine.size()};
    if (!mine.empty()) std::memcpy(own.bytes.data(), mine.data(), own.there());
    std::vector<Beginning> beginnings(ranks());
    std::vector<std::size_t> sizes(ranks(), sizeof own);
    require_success(to_.gather(to_.context, &own, sizes.data(), beginnings.data()), "gather");
    constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
    std::uint64_t left = 0;
    for (std::size_t rank = 0; rank < ranks(); ++rank) {
        sizes[rank] = beginnings[rank].size - beginnings[rank].there();
        // Each of them by itself, too, so that the sum stays right.
        left += std::min<std::uint64_t>(sizes[rank], most + 1);
    }
    if (left > most)
        throw LimitExceeded("the ranks have " + std::to_string(left) + " bytes to tell all others, at most " +
                            std::to_string(most) + " are possible: let fewer ranks reconstruct (reconstruct-ranks)");
    Bytes rest(left);
    if (left != 0)
        require_success(to_.gather(to_.context, mine.data() + own.there(), sizes.data(), rest.data()), "gather");
    std::vector<Bytes> of_ranks;
    auto at = rest.begin();
    for (std::size_t rank = 0; rank < ranks(); ++rank) {
        const auto begin = beginnings[rank].bytes.begin();
        Bytes& its = of_ranks.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(beginnings[rank].there()));
        const auto end = at + static_cast<std::ptrdiff_t>(sizes[rank]);
        its.insert(its.end(), at, end);
        at = end;
    }
    return of_ranks;
}

void RankExchange::all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) {
    std::vector<std::uint64_t> to_sizes(ranks()), from_sizes(ranks());
    for (std::size_t rank = 0; rank < ranks(); ++rank) to_sizes[rank] = to[rank].size();
    require_success(to_.trade_sizes(to_.context, to_sizes.data(), from_sizes.data()), "trade_sizes");
    from.resize(ranks());
    from[rank()].swap(to[rank()]);
    receive(from_sizes, from);
    from_sizes[rank()] = to_sizes[rank()] = 0;
    std::vector<const void*> sent(ranks());
    std::vector<void*> received(ranks());
    for (std::size_t rank = 0; rank < ranks(); ++rank) {
        sent[rank] = to[rank].data();
        received[rank] = from[rank].data();
    }
    require_success(to_.trade(to_.context, sent.data(), to_sizes.data(), received.data(), from_sizes.data()), "trade");
}

void RankExchange::receive(const std::vector<std::uint64_t>& sizes, std::vector<Bytes>& from) {
    Bytes is_there(1, std::byte{1});
    try {
        for (std::size_t rank = 0; rank < from.size(); ++rank) from[rank].resize(sizes[rank]);
    } catch (const std::exception&) {  // bad_alloc, or more than a vector can have
        is_there[0] = std::byte{0};
    }
    const std::vector<Bytes> all = gather(std::move(is_there));
    for (std::size_t rank = 0; rank < all.size(); ++rank)
        if (all[rank].at(0) == std::byte{0})
            throw LimitExceeded("rank " + std::to_string(rank) +
                                " has not enough memory for the particles that it is to reconstruct from: let more "
                                "ranks reconstruct (reconstruct-ranks)");
}

void RankExchange::release() const {
    if (to_.release != nullptr) to_.release(to_.context);
}

}  // namespace meniscus::c
