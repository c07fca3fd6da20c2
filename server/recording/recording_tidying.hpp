// Deletes the recordings that are not to be kept: those of an earlier server when this one starts, then those that grow
// old.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>

#include "recording/recording_options.hpp"
#include "recording/recording_reads.hpp"
#include "sessions/handover/timer.hpp"

namespace meniscus::server {

class RecordingTidying {
public:
    /// Looks into the folder at once, and after each interval, on the thread that reads; never where all are to be
    /// kept. reads outlives this object.
    RecordingTidying(RecordingReads& reads, const RecordingRetention& retention,
                     std::chrono::milliseconds interval = std::chrono::minutes(1));

private:
    void look();

    RecordingReads& reads_;
    const RecordingRetention retention_;
    /// A folder of very many files takes longer than the interval.
    const std::shared_ptr<std::atomic<bool>> waits_ = std::make_shared<std::atomic<bool>>(false);
    Timer timer_;  ///< last: it uses the others
};

}  // namespace meniscus::server
