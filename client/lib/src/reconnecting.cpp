#include "reconnecting.hpp"

#include <algorithm>

namespace meniscus::client {

void report_reconnecting(const ReconnectHandler& handler, const ReconnectEvent& event) noexcept {
    if (!handler) return;
    try {
        handler(event);
    } catch (...) {
        // The connection does not depend on its listener.
    }
}

std::chrono::milliseconds time_left(std::chrono::steady_clock::time_point until) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    return std::max(left, std::chrono::milliseconds(0));
}

}  // namespace meniscus::client
