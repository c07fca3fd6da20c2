// The session's second thread: meshes become messages, for the stream and for the watchers, each format once.
#include <algorithm>
#include <utility>

#include "log.hpp"
#include "meniscus/error.hpp"
#include "sessions/refusal.hpp"
#include "sessions/session.hpp"
#include "sessions/stream_notices.hpp"

namespace meniscus::server {

namespace {

/// The one that a watcher with the stream's wishes shares.
MeshFormat stream_format(const UploadOptions& options, const Settings& settings) {
    return {.max_level = 3,
            .position_bits = static_cast<int>(offset_bits(settings)),
            .normal_bits = settings.normals ? options.normal_bits : 0};
}

}  // namespace

void Session::encode_frames() {
    while (auto task = tasks_.take()) {
        try {
            std::visit([this](auto& t) { perform(t); }, *task);
        } catch (const DeviceError& error) {
            log_error({.session = id()}, "the session ends: {}", error.what());
            EndSession end{std::current_exception()};
            perform(end);
        }
    }
}

void Session::give_back(ReconstructedFrame& frame) {
    frame.download = {};  // of a mesh that nobody may have wanted
    free_frames_.put(&frame);
}

void Session::perform(Encode& task) {
    Upload& upload = *task.upload;
    // Also when nobody reads any more: the frame was received, and watchers get it.
    upload.output.wait_for_room();
    auto& last_finished = upload.run->last_finished;
    if (last_finished && task.frame->index <= *last_finished) return answer_again(task);
    last_finished = task.frame->index;
    if (newest_ != nullptr) give_back(*newest_);
    newest_ = task.frame;
    {
        const std::lock_guard lock(mutex_);
        before_ = std::exchange(published_, {});
    }
    try {
        if (upload.options.receive_meshes) {
            const MeshFormat format = stream_format(upload.options, settings_);
            const auto encoded =
                encode_newest(format, [&](const SharedMessage& message) { upload.output.push(message); });
            count_answer(encoded->statistics);
            publish(format, encoded);
        } else {
            const FrameStatistics statistics = statistics_of(*newest_);
            count_answer(statistics);
            upload.output.push(serialize(statistics));
        }
    } catch (const DeviceError&) {
        throw;
    } catch (...) {
        EndUpload end{.upload = task.upload, .error = std::current_exception()};
        perform(end);
    }
    answered(upload);
    encode_for_watchers();
    if (observer_) encode_for_observer();
    before_.clear();
}

void Session::answer_again(Encode& task) {
    Upload& upload = *task.upload;
    try {
        if (upload.options.receive_meshes)
            encode_frame(*task.frame, stream_format(upload.options, settings_), nullptr, *shared_.workers,
                         [&](const SharedMessage& message) { upload.output.push(message); });
        else
            upload.output.push(serialize(statistics_of(*task.frame)));
    } catch (const DeviceError&) {
        throw;
    } catch (...) {
        EndUpload end{.upload = task.upload, .error = std::current_exception()};
        perform(end);
    }
    answered(upload);
    give_back(*task.frame);
}

void Session::answered(Upload& upload) {
    upload.last_activity = Upload::Clock::now();
    --upload.owed;
}

void Session::perform(ReportDrop& task) {
    Upload& upload = *task.upload;
    upload.output.wait_for_room();
    upload.output.push(frame_dropped_message(task.dropped));
    upload.unreported_drops.report();
    answered(upload);
}

void Session::perform(EndUpload& task) {
    std::vector<std::shared_ptr<Watch>> done;
    bool moves = false;
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == task.upload) upload_.reset();
        std::erase(unanswered_, task.upload);
        last_used_ = std::chrono::steady_clock::now();
        if (draining_ && !upload_) done = watches_;
        // Another run may have come since, and is here still or waits for answers.
        moves = task.upload && task.upload->moves && !upload_ &&
                std::ranges::all_of(unanswered_, [&](const auto& other) { return other->run == task.upload->run; });
    }
    if (moves) {
        log_info({.session = id()}, "its simulator goes on with another server");
        EndSession end{std::make_exception_ptr(moved())};
        perform(end);
    }
    // Only now: who hears of the end may open the next stream.
    if (task.upload) task.upload->output.finish(task.error);
    for (const auto& watch : done) watch->finish(std::make_exception_ptr(shutting_down()));
}

void Session::perform(EndSession& task) {
    const Attached attached = detach();
    for (const auto& upload : attached.uploads) upload->output.finish(task.error);
    for (const auto& watch : attached.watches) watch->finish(task.error);
}

void Session::perform(EncodeForWatchers&) {
    encode_for_watchers();
}

void Session::count_answer(const FrameStatistics& statistics) {
    shared_.metrics->frame_finished(statistics);
    const std::lock_guard lock(mutex_);
    state_.last_frame = statistics;
}

void Session::perform(AddCapped& task) {
    // A newer frame has it already: the watcher was there when that was reconstructed.
    if (newest_ == nullptr || newest_->number != task.frame_number) return;
    auto& capped = newest_->capped_at(task.max_level);
    if (!capped.made) capped.mesh = std::move(task.mesh);
    capped.made = true;
    encode_for_watchers();
}

std::shared_ptr<const EncodedFrame> Session::encode_newest(const MeshFormat& format, const MessageSink& sink) {
    const auto before = before_.find(format);
    return encode_frame(*newest_, format, before != before_.end() ? before->second.get() : nullptr, *shared_.workers,
                        sink);
}

void Session::publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        published_[format] = frame;
        for (const auto& watch : watches_)
            if (watch->wishes().wants(format)) watches.push_back(watch);
    }
    for (const auto& watch : watches) watch->put(frame);
}

void Session::encode_for_watchers() {
    if (newest_ == nullptr) return;
    try {
        while (const auto format = unpublished_format()) publish(*format, encode_newest(*format, nullptr));
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = id(), .frame = newest_->index},
                  "not encoded for its watchers, who keep the frame before: {}", error.what());
    }
}

void Session::encode_for_observer() {
    const MeshFormat format = stream_format({.normal_bits = SessionObserver::normal_bits}, settings_);
    std::shared_ptr<const EncodedFrame> frame;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = published_.find(format); found != published_.end()) frame = found->second;
    }
    try {
        if (!frame) publish(format, frame = encode_newest(format, nullptr));
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = id(), .frame = newest_->index}, "not encoded for its recording: {}", error.what());
        return;
    }
    observer_->encoded(std::move(frame));
}

std::optional<MeshFormat> Session::unpublished_format() const {
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_) {
        const MeshFormat& format = watch->wishes().format;
        if (watch->wishes().wants(format) && !published_.contains(format) &&
            newest_->mesh_at(format.max_level) != nullptr)
            return format;
    }
    return std::nullopt;
}

}  // namespace meniscus::server
