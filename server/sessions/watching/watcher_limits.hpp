// How many watchers a session takes, and in how many forms: over all callers, and of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sessions/limits/limits.hpp"
#include "sessions/limits/name_account.hpp"
#include "sessions/watching/watch.hpp"
#include "sessions/watching/watch_options.hpp"

namespace meniscus::server {

/// Throws LimitReached for one watcher too many beside those that a session has, or one form. watcher: may be none.
/// session: its id, for the message.
void require_room_for(const WatchOptions& options, const NameAccount* watcher,
                      std::vector<std::shared_ptr<Watch>> watches, const std::string& session, const Limits& limits);

}  // namespace meniscus::server
