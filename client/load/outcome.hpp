// Counts and latencies, as the clients of a run measured them.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <string>

#include "load/latencies.hpp"
#include "load/schedule.hpp"

namespace meniscus::load {

/// Failures by gRPC status, such as "UNAVAILABLE"; "CLIENT" for errors that the client library itself found.
using Errors = std::map<std::string, std::uint64_t>;

/// Counts an exception.
void count_error(Errors& errors, const std::exception_ptr& error);

/// Results of the simulators. Latencies are those of frames after the warm-up, all else is of the whole run.
struct UploadOutcome {
    Latencies answer;      ///< from the time at which a frame was due to the end of its answer
    Latencies send_delay;  ///< from the time at which a frame was due to the begin of its upload
    std::uint64_t sent = 0;
    std::uint64_t answered = 0;
    std::uint64_t dropped = 0;   ///< frames that the upload policy dropped, by the server's reports
    std::uint64_t not_sent = 0;  ///< due, but the run had ended or the stream had failed
    std::uint64_t particles = 0;
    std::uint64_t upload_bytes = 0;
    std::uint64_t mesh_bytes = 0;
    Clock::time_point last_answer;
    Errors errors;

    void add(const UploadOutcome& more);
    /// Frames that were sent, and neither answered nor dropped.
    std::uint64_t lost() const { return sent - answered - dropped; }
};

/// Results of the watchers of one kind.
struct WatchOutcome {
    Latencies latency;  ///< from the time at which a frame was due to its arrival
    std::uint64_t frames = 0;
    std::uint64_t skipped = 0;   ///< frames missing between two that arrived
    std::uint64_t vanished = 0;  ///< connections that watchers broke
    std::uint64_t mesh_bytes = 0;
    Errors errors;

    void add(const WatchOutcome& more);
};

}  // namespace meniscus::load
