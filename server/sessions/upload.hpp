// One uploading stream, as its session sees it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "sessions/limits/unreported_drops.hpp"
#include "sessions/output_queue.hpp"

namespace meniscus::server {

/// What happens to frames that come faster than they are reconstructed.
enum class UploadPolicy {
    every_frame,  ///< the simulator is slowed down
    latest,       ///< the newest one replaces those that wait
    every_nth,    ///< of every n the first is reconstructed; of those none is lost
};

struct UploadOptions {
    bool receive_meshes = false;
    int normal_bits = 0;
    UploadPolicy policy = UploadPolicy::every_frame;
    std::uint32_t nth = 1;     ///< at least 1; of UploadPolicy::every_nth
    std::uint64_t run_id = 0;  ///< 0: a run of its own
};

/// Frames that belong together, over one stream or over several, each of which resumed the run.
struct Run {
    std::uint64_t id = 0;
    std::optional<std::uint64_t> last_shown = {};     ///< index of a frame; of the reconstructing thread
    std::optional<std::uint64_t> last_finished = {};  ///< the same, of the encoding thread
};

struct Upload {
    using Clock = std::chrono::steady_clock;

    /// wake: as OutputQueue has it. stop_receiving: called when the session is to take no further frame than the one on
    /// its way in.
    Upload(const UploadOptions& wishes, std::function<void()> wake, std::function<void()> stop_receiving)
        : options(wishes), output(std::move(wake)), drain(std::move(stop_receiving)) {}

    const UploadOptions options;
    OutputQueue output;
    const std::function<void()> drain;
    std::shared_ptr<Run> run;  ///< set once, before others see the upload

    std::uint64_t submitted = 0;  ///< frames, dropped ones included; with the session's lock held
    UnreportedDrops unreported_drops;
    std::atomic<std::uint64_t> owed{0};  ///< frames submitted and not yet answered
    std::atomic<Clock::time_point> last_activity{Clock::now()};
    std::atomic<bool> moves{false};  ///< its simulator goes on with another server: the session ends behind it
};

}  // namespace meniscus::server
