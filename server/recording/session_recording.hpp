// Hands what one session does to the writer of recordings.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "recording/recording_writer.hpp"
#include "sessions/session/session_observer.hpp"

namespace meniscus::server {

/// Particles are copied, at the speed of memory (a thousandth of what their reconstruction takes): their buffer goes
/// back to the stream at once. Meshes are shared. A frame that finds no room in the queue is left out; the log
/// says so once.
class SessionRecording final : public SessionObserver {
public:
    /// The writer outlives this object. session_id: a UUID, as the edge has verified. owner: the creator of the
    /// session; may be empty.
    SessionRecording(RecordingWriter& writer, std::string session_id, const Settings& settings, std::string owner = {},
                     v1::SessionDescription description = {});

    const char* product() const noexcept override { return "recording"; }
    Codec codec() const noexcept override { return writer_.codec(); }
    int attribute_bits() const noexcept override { return writer_.attribute_bits(); }
    void reconstructed(const InputFrame& frame) noexcept override;
    void encoded(std::shared_ptr<const EncodedFrame> frame) noexcept override;

private:
    struct Frame {
        std::uint64_t index = 0;
        std::shared_ptr<RecordedRun> run;
    };

    /// The run that the frame continues or begins.
    std::shared_ptr<RecordedRun> run_of(const InputFrame& frame);
    /// That of a frame whose particles were recorded and whose mesh comes now; none if they were not.
    std::shared_ptr<RecordedRun> run_without_mesh(std::uint64_t index);
    void left_out(std::uint64_t index, const char* what);

    RecordingWriter& writer_;
    const std::shared_ptr<RecordedSession> session_;
    std::atomic<bool> said_so_{false};
    std::mutex mutex_;  ///< for what follows
    std::shared_ptr<RecordedRun> run_;
    std::uint64_t last_index_ = 0;    ///< of the run
    std::deque<Frame> without_mesh_;  ///< recorded, in order
};

}  // namespace meniscus::server
