// How many snapshots are under way, on the server and of each caller.
#pragma once

#include <cstdint>
#include <memory>

#include "sessions/limits/name_account.hpp"

namespace meniscus::server {

/// Thread-safe. Places may outlive it.
class SnapshotPlaces {
public:
    /// 0 means no limit.
    SnapshotPlaces(std::uint32_t all, std::uint32_t of_one_name);

    /// The place of a call, held for as long as it is under way.
    using Place = std::shared_ptr<void>;
    /// caller: may be none. Throws LimitReached.
    Place take(const std::shared_ptr<NameAccount>& caller);

private:
    const std::uint32_t limit_;
    const std::uint32_t limit_of_name_;
    const std::shared_ptr<std::atomic<std::uint32_t>> taken_ = std::make_shared<std::atomic<std::uint32_t>>(0);
};

}  // namespace meniscus::server
