// The common part of the calls that read recordings: one thread that waits for the disk, so that no thread of gRPC
// does, and no session.
#pragma once

#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>

#include "recording/recording_catalog.hpp"

namespace meniscus::server {

class RecordingReads {
public:
    /// readers: the number that may read at a time; 0: no limit. patience: how long each may take for a message; 0: for
    /// ever.
    RecordingReads(std::filesystem::path directory, std::uint32_t readers, std::chrono::milliseconds patience);
    ~RecordingReads();
    RecordingReads(const RecordingReads&) = delete;
    RecordingReads& operator=(const RecordingReads&) = delete;

    std::chrono::milliseconds patience() const noexcept { return patience_; }

    /// The place of a reader, held for as long as it reads.
    using Place = std::shared_ptr<void>;
    /// Throws LimitReached, or Refusal once the server goes down.
    Place admit();
    std::uint32_t readers() const noexcept { return readers_; }

    /// Runs the job on the thread that reads, after those posted before. It throws nothing. Readers post one message at
    /// a time, and so take turns.
    void post(std::function<void(RecordingCatalog&)> job);

    /// Runs a job that looks into the whole folder. It begins once as much time has passed as the one before took, so
    /// that at least half of the thread's time is the readers'.
    void post_scan(std::function<void(RecordingCatalog&)> job);

    /// Readers end at their next message; what waits is run at once.
    void end();
    /// Throws Refusal once the server goes down.
    void require_going_on() const;

private:
    /// Begins the first of scans_ once the time has come.
    void wait_to_scan();

    const std::uint32_t limit_;
    const std::chrono::milliseconds patience_;
    std::atomic<std::uint32_t> readers_{0};
    std::atomic<bool> ending_{false};
    RecordingCatalog catalog_;                                  ///< of the thread
    std::deque<std::function<void(RecordingCatalog&)>> scans_;  ///< of the thread: they wait, or the first is under way
    boost::asio::thread_pool thread_{1};
    boost::asio::steady_timer next_scan_{thread_};  ///< of the thread
};

}  // namespace meniscus::server
