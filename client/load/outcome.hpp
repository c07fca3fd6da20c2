// What the clients of a run have seen.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <string>

#include "load/latencies.hpp"
#include "load/schedule.hpp"

namespace meniscus::load {

/// Failures by gRPC status, such as "UNAVAILABLE"; "CLIENT" for what the client library found wrong itself.
using Errors = std::map<std::string, std::uint64_t>;

/// Counts what was thrown.
void count_error(Errors& errors, const std::exception_ptr& error);

/// Of the simulators. Latencies are of the frames after the warm-up alone, everything else is of the whole run.
struct UploadOutcome {
    Latencies answer;      ///< from when a frame was due until its whole answer was there
    Latencies send_delay;  ///< from when a frame was due until its sending began
    std::uint64_t sent = 0;
    std::uint64_t answered = 0;
    std::uint64_t dropped = 0;   ///< by the upload policy, as the server reported
    std::uint64_t not_sent = 0;  ///< due, but the run was over or the stream had failed
    std::uint64_t particles = 0;
    std::uint64_t upload_bytes = 0;
    std::uint64_t mesh_bytes = 0;
    Clock::time_point last_answer;
    Errors errors;

    void add(const UploadOutcome& more);
    /// Sent, and neither answered nor dropped.
    std::uint64_t lost() const { return sent - answered - dropped; }
};

/// Of watchers of one kind.
struct WatchOutcome {
    Latencies latency;  ///< from when a frame was due until the watcher had it
    std::uint64_t frames = 0;
    std::uint64_t skipped = 0;   ///< frames that went by between two that came
    std::uint64_t vanished = 0;  ///< times that a watcher broke its connection
    std::uint64_t mesh_bytes = 0;
    Errors errors;

    void add(const WatchOutcome& more);
};

}  // namespace meniscus::load
