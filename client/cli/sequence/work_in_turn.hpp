// Several frames at a time, with the outcome of one after the other.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace meniscus::cli {

/// The work of a worker on an item. It calls `wait_for_turn` before the first thing that anybody else sees: that
/// returns once the items before are done, and does not return if one of them has failed.
using Work = std::function<void(std::size_t item, const std::function<void()>& wait_for_turn)>;

/// Hands items 0 to count - 1 to the workers, each on a thread of its own; one alone works on this thread. Each worker
/// has one item at a time, so that no more than there are workers are in memory. Throws what the first of the items
/// that failed has thrown; what comes after it is not seen by anybody.
void work_in_turn(std::size_t count, std::span<const Work> workers);

}  // namespace meniscus::cli
