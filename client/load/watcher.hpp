// Watchers that read: as fast as they can, slowly, or for a few frames and then no more.
#pragma once

#include <atomic>
#include <string>

#include "load/outcome.hpp"
#include "load/schedule.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

/// Reads until the session ends. pause: seconds that it takes over each frame, 0 for none; not any more once the
/// simulators are done.
WatchOutcome watch(client::Watcher& watcher, const Schedule& schedule, double pause, const std::atomic<bool>& over);

/// Connects, reads so many frames and breaks the connection, again and again until the session ends. over: the end is
/// due, so that a session that is gone is no error.
WatchOutcome watch_and_vanish(const std::string& server, const client::ConnectionOptions& connection,
                              const std::string& session, const Schedule& schedule, std::uint64_t frames,
                              const std::atomic<bool>& over);

}  // namespace meniscus::load
