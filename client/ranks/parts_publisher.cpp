#include "ranks/parts_publisher.hpp"

#include <algorithm>

namespace meniscus::ranks {
namespace {

constexpr std::chrono::seconds longest_pause{30};

}  // namespace

void PartsPublisher::abandon() noexcept {
    leave();
    next_attempt_ = Clock::now() + pause_;
    pause_ = std::min(2 * pause_, longest_pause);
}

}  // namespace meniscus::ranks
