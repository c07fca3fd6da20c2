// What uploads to a session: one stream, or one for each part of the frames.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/codec.hpp"
#include "sessions/limits/unreported_drops.hpp"
#include "sessions/limits/upload_pace.hpp"
#include "sessions/sending/output_queue.hpp"

namespace meniscus::server {

/// What comes in the frames of an upload, and of all uploads to its session.
enum class FrameKind : std::uint8_t {
    particles,  ///< to be reconstructed
    bricks,     ///< of a surface that was made elsewhere
};
constexpr std::string_view name_of(FrameKind kind) {
    switch (kind) {
        case FrameKind::particles:
            return "particles";
        case FrameKind::bricks:
            return "bricks";
    }
    return {};
}

/// The treatment of frames that come faster than they are reconstructed.
enum class UploadPolicy {
    every_frame,  ///< the simulator is slowed down
    latest,       ///< the newest one replaces those that wait
    every_nth,    ///< the first of every n is reconstructed; none of those is lost
};

/// How a stream's call has ended.
enum class UploadEnd : std::uint8_t {
    answered,  ///< with a status that its simulator was sent
    vanished,  ///< canceled, or its connection broke, before that: a read that fails for it looks as if nothing
               ///< followed
};

struct UploadOptions {
    FrameKind frames = FrameKind::particles;
    bool receive_meshes = false;
    int normal_bits = 0;
    Codec codec = Codec::draco;
    bool spray = false;                       ///< whether it comes beside the meshes
    std::vector<AttributeWish> attributes{};  ///< that the meshes carry
    UploadPolicy policy = UploadPolicy::every_frame;
    std::uint32_t nth = 1;                   ///< at least 1; for UploadPolicy::every_nth
    std::uint64_t run_id = 0;                ///< 0: a run of its own
    std::uint32_t parts = 1;                 ///< streams, each of which sends a part of every frame
    bool resumes = false;                    ///< whether it goes on where a stream of its run and part has broken off
    std::chrono::milliseconds reconnect{0};  ///< for how long its simulator tries to come back
};

/// Frames that belong together, over one stream or over several, each of which resumed the run.
struct Run {
    std::uint64_t id = 0;
    std::optional<std::uint64_t> last_shown = {};     ///< index of a frame; used by the reconstructing thread alone
    std::optional<std::uint64_t> last_finished = {};  ///< index of a frame; used by the encoding thread alone
    std::atomic<bool> has_begun{false};               ///< its first frame, over all parts
    /// Whose streams have ended well, and come again only where they have not heard of that; with the lock of
    /// JointUploads.
    std::set<std::uint32_t> finished_parts = {};
};

struct Upload {
    using Clock = std::chrono::steady_clock;

    /// wake: see OutputQueue, whose readers are the parts. stop_receiving: called when the frame on its way in is to be
    /// the last. stop_at_once: when it is not wanted any more; the stream then ends with the error.
    Upload(
        const UploadOptions& upload_options, std::function<void(std::size_t)> wake,
        std::function<void()> stop_receiving,
        std::function<void(std::exception_ptr)> stop_at_once = [](const std::exception_ptr&) {})
        : options(upload_options),
          output(std::move(wake), options.parts),
          drain(std::move(stop_receiving)),
          stop(std::move(stop_at_once)) {}

    UploadOptions options;  ///< those of its answers are part 0's, and there before the first frame
    OutputQueue output;
    const std::function<void()> drain;
    const std::function<void(std::exception_ptr)> stop;
    std::shared_ptr<Run> run;  ///< set once, before others see the upload

    UploadPace pace;
    std::atomic<std::uint32_t> missing_parts{0};  ///< that have not come yet
    std::atomic<bool> waits_for_parts{false};     ///< some wait for others, which compute: it is not idle
    std::uint64_t submitted = 0;                  ///< frames, dropped ones included; with the session's lock held
    UnreportedDrops unreported_drops;
    std::atomic<std::uint64_t> owed{0};  ///< frames submitted and not yet answered
    std::atomic<Clock::time_point> last_activity{Clock::now()};
    std::atomic<bool> canceled{false};  ///< nobody reads its answers any more
    std::atomic<bool> moves{
        false};  ///< its simulator goes on with another server: the session ends after its last frame
};

}  // namespace meniscus::server
