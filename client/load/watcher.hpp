// Watchers that read as fast as they can, slowly, or for a few frames at a time.
#pragma once

#include <atomic>
#include <string>

#include "load/outcome.hpp"
#include "load/schedule.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::load {

/// Reads until the session ends. pause: seconds that the watcher takes over each frame, until the simulators are done;
/// 0 for none.
WatchOutcome watch(client::Watcher& watcher, const Schedule& schedule, double pause, const std::atomic<bool>& over);

/// Connects, reads a number of frames and breaks the connection, again and again until the session ends. over: whether
/// that end is due; a missing session is then no error.
WatchOutcome watch_and_vanish(const std::string& server, const client::ConnectionOptions& connection,
                              const std::string& session, const Schedule& schedule, std::uint64_t frames,
                              const std::atomic<bool>& over);

}  // namespace meniscus::load
