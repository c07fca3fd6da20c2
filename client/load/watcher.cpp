#include "load/watcher.hpp"

#include <optional>
#include <thread>

namespace meniscus::load {

namespace {

/// Counts the frames of one watcher.
class Reading {
public:
    Reading(const Schedule& schedule, WatchOutcome& outcome) : schedule_(schedule), outcome_(outcome) {}

    /// False at the end of the session.
    bool next(client::Watcher& watcher) {
        const auto frame = watcher.next();
        if (!frame) return false;
        const Clock::time_point now = Clock::now();
        ++outcome_.frames;
        outcome_.mesh_bytes += frame->statistics.encoded_bytes;
        if (before_) outcome_.skipped += frame->index - *before_ - 1;
        // The first may have been there before the watcher came.
        if (before_ && schedule_.measured(frame->index))
            outcome_.latency.add(seconds_between(schedule_.due(frame->index), now));
        before_ = frame->index;
        return true;
    }

private:
    const Schedule& schedule_;
    WatchOutcome& outcome_;
    std::optional<std::uint64_t> before_;
};

}  // namespace

WatchOutcome watch(client::Watcher& watcher, const Schedule& schedule, double pause, const std::atomic<bool>& over) {
    WatchOutcome outcome;
    try {
        Reading reading(schedule, outcome);
        while (reading.next(watcher))
            if (!over) std::this_thread::sleep_for(std::chrono::duration<double>(pause));
    } catch (...) {
        count_error(outcome.errors, std::current_exception());
    }
    return outcome;
}

WatchOutcome watch_and_vanish(const std::string& server, const client::ConnectionOptions& connection,
                              const std::string& session, const Schedule& schedule, std::uint64_t frames,
                              const std::atomic<bool>& over) {
    WatchOutcome outcome;
    while (!over) {
        try {
            client::Client client(server, connection);
            client::Watcher watcher = client.watch(session);
            Reading reading(schedule, outcome);
            for (std::uint64_t i = 0; i < frames; ++i)
                if (!reading.next(watcher)) return outcome;
            ++outcome.vanished;
        } catch (...) {
            if (over) break;
            count_error(outcome.errors, std::current_exception());
            break;
        }
    }
    return outcome;
}

}  // namespace meniscus::load
