// The ranks of the C interface as processes that exchange.
#pragma once

#include <cstdint>
#include <vector>

#include "meniscus/meniscus.h"
#include "meniscus/parts.hpp"

namespace meniscus::c {

class RankExchange final : public PartExchange {
public:
    /// Throws InvalidInput for a struct that makes no sense.
    explicit RankExchange(const meniscus_exchange* exchange);

    std::size_t rank() const override { return to_.rank; }
    std::size_t ranks() const override { return to_.ranks; }
    bool leads_node() const { return to_.leads_node != 0; }
    std::vector<Bytes> gather(Bytes mine) override;
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override;
    void release() const;

private:
    /// Throws LimitExceeded, in all ranks, where one has no memory.
    void receive(const std::vector<std::uint64_t>& sizes, std::vector<Bytes>& from);

    meniscus_exchange to_;
};

}  // namespace meniscus::c
