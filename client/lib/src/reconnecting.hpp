// Reports to a caller about attempts to go on.
#pragma once

#include <chrono>

#include "meniscus/client/reconnect_event.hpp"

namespace meniscus::client {

/// Calls the handler, if there is one; what it throws is lost.
void report_reconnecting(const ReconnectHandler& handler, const ReconnectEvent& event) noexcept;

/// The time that is left until then, at least 0.
std::chrono::milliseconds time_left(std::chrono::steady_clock::time_point until);

}  // namespace meniscus::client
