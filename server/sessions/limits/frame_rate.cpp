#include "sessions/limits/frame_rate.hpp"

#include <algorithm>

namespace meniscus::server {

bool FrameRate::take(Clock::time_point now) {
    if (limit_ == 0.0) return true;
    tokens_ = tokens_at(now);
    filled_at_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
}

double FrameRate::tokens_at(Clock::time_point now) const {
    return std::min(limit_, tokens_ + limit_ * std::chrono::duration<double>(now - filled_at_).count());
}

}  // namespace meniscus::server
