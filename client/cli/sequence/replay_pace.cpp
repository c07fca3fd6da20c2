#include "cli/sequence/replay_pace.hpp"

#include <charconv>
#include <cmath>
#include <thread>

#include "meniscus/error.hpp"

namespace meniscus::cli {

ReplayPace::ReplayPace(const std::string& speed) {
    if (speed == "max") return;
    const char* end = speed.data() + speed.size();
    const auto [parsed, error] = std::from_chars(speed.data(), end, speed_);
    if (error != std::errc() || parsed != end || !std::isfinite(speed_) || speed_ <= 0.0)
        throw InvalidInput("--speed '" + speed + "' is neither a number greater than 0 nor max");
}

void ReplayPace::wait(std::chrono::duration<double> since_first) {
    const auto now = std::chrono::steady_clock::now();
    if (!first_) first_ = now;
    if (speed_ > 0.0) std::this_thread::sleep_for(since_first / speed_ - (now - *first_));
}

}  // namespace meniscus::cli
