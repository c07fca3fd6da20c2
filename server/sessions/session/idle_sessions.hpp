// Which sessions a caller could delete, where there is no room for another one.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sessions/session/session.hpp"

namespace meniscus::server {

/// Names those without a stream that the caller may see, and so may delete, by name, id and for how long they have had
/// none: the five that have been without one for the longest time, and the number of the others. For a refusal's text,
/// behind others: begins with ";". may_see: of a session's owner; empty: all.
std::string name_idle_sessions(const std::vector<std::shared_ptr<Session>>& sessions,
                               const std::function<bool(const std::string& owner)>& may_see,
                               std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now());

}  // namespace meniscus::server
