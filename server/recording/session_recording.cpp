#include "recording/session_recording.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "process/log.hpp"

namespace meniscus::server {

namespace {

/// More than a session has between its reconstruction and its encoding.
constexpr std::size_t frames_under_way = 8;

}  // namespace

SessionRecording::SessionRecording(RecordingWriter& writer, std::string session_id, const Settings& settings,
                                   std::string owner, v1::SessionDescription description)
    : writer_(writer), session_(std::make_shared<RecordedSession>()) {
    session_->id = std::move(session_id);
    session_->settings = settings;
    session_->owner = std::move(owner);
    session_->description = std::move(description);
}

void SessionRecording::reconstructed(const InputFrame& frame) noexcept {
    if (session_->stopped) return;
    const std::size_t bytes = frame.bytes.size();
    bool reserved = false;
    try {
        reserved = writer_.reserve(*session_, bytes);
        if (!reserved) return left_out(frame.index, "the disk does not keep up");
        auto particles = recorded_particles(frame, writer_.wall_clock(frame.received_at));
        const std::lock_guard lock(mutex_);
        auto run = run_of(frame);
        without_mesh_.push_back({.index = frame.index, .run = run});
        if (without_mesh_.size() > frames_under_way) without_mesh_.pop_front();
        writer_.write(std::move(run), frame.index, std::move(particles), bytes);
    } catch (const std::exception& error) {
        if (reserved) writer_.cancel(*session_, bytes);
        left_out(frame.index, error.what());
    }
}

void SessionRecording::encoded(std::shared_ptr<const EncodedFrame> frame) noexcept {
    if (session_->stopped) return;
    const std::uint64_t index = frame->index;
    auto run = run_without_mesh(index);
    if (!run) return;
    std::size_t bytes = 0;
    frame->for_each_message([&](const SharedMessage& message) { bytes += message->size(); });
    bool reserved = false;
    try {
        reserved = writer_.reserve(*session_, bytes);
        if (!reserved) return left_out(index, "the disk does not keep up");
        writer_.write(std::move(run), index, std::move(frame), bytes);
    } catch (const std::exception& error) {
        if (reserved) writer_.cancel(*session_, bytes);
        left_out(index, error.what());
    }
}

std::shared_ptr<RecordedRun> SessionRecording::run_without_mesh(std::uint64_t index) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(without_mesh_.begin(), without_mesh_.end(),
                                    [&](const Frame& frame) { return frame.index == index; });
    if (found == without_mesh_.end()) return nullptr;
    auto run = std::move(found->run);
    without_mesh_.erase(without_mesh_.begin(), found + 1);
    return run;
}

std::shared_ptr<RecordedRun> SessionRecording::run_of(const InputFrame& frame) {
    if (!run_ || frame.index <= last_index_) {
        run_ = writer_.begin_run(session_, writer_.wall_clock(frame.received_at));
    }
    last_index_ = frame.index;
    return run_;
}

void SessionRecording::left_out(std::uint64_t index, const char* what) {
    if (said_so_.exchange(true)) return;
    log_warning({.session = session_->id, .frame = index},
                "the frame or its mesh is not recorded, and others may not be: {}", what);
}

}  // namespace meniscus::server
