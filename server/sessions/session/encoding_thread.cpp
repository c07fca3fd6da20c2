#include "sessions/session/encoding_thread.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "process/log.hpp"
#include "sessions/handover/start_thread.hpp"
#include "sessions/sending/stream_notices.hpp"
#include "sessions/watching/canonical_attributes.hpp"

namespace meniscus::server {

namespace {

/// A watcher that asks for the same shares the stream's encode.
MeshFormat stream_format(int normal_bits, Codec codec, const std::vector<AttributeWish>& attributes,
                         const Settings& settings) {
    return {.max_level = 3,
            .position_bits = static_cast<int>(offset_bits(settings)),
            .normal_bits = settings.normals ? normal_bits : 0,
            .codec = codec,
            .attributes = canonical_attributes(attributes, settings)};
}

MeshFormat stream_format(const UploadOptions& options, const Settings& settings) {
    return stream_format(options.normal_bits, options.codec, options.attributes, settings);
}

}  // namespace

EncodingThread::EncodingThread(const SessionContext& context, Watchers& watchers, Ends ends)
    : context_(context),
      watchers_(watchers),
      ends_(std::move(ends)),
      scratch_(std::make_shared<MemoryAccount>(context.limits.bytes_per_session, "to encode its mesh",
                                               context.shared.memory)) {
    for (ReconstructedFrame& frame : frames_) free_frames_.put(&frame);
    thread_ =
        start_thread(fmt::format("that encodes the meshes of session {}", context.identity.id), [this] { run(); });
}

EncodingThread::~EncodingThread() {
    close();
    join();
}

ReconstructedFrame* EncodingThread::wait_for_free_frame() {
    return free_frames_.take().value_or(nullptr);
}

std::optional<FrameStatistics> EncodingThread::last_frame() const {
    const std::lock_guard lock(mutex_);
    return last_frame_;
}

void EncodingThread::close() {
    free_frames_.close();
    tasks_.close();
}

void EncodingThread::join() {
    if (thread_.joinable()) thread_.join();
}

void EncodingThread::release_memory() {
    before_.clear();
    newest_ = nullptr;
    for (ReconstructedFrame& frame : frames_) frame.release_memory();
    scratch_.release_memory();
}

void EncodingThread::run() {
    while (auto task = tasks_.take()) {
        try {
            std::visit([this](auto& t) { perform(t); }, *task);
        } catch (const DeviceError& error) {
            log_error({.session = context_.identity.id}, "the session ends: {}", error.what());
            ends_.session(std::current_exception());
        }
        --pending_;
    }
}

void EncodingThread::give_back(ReconstructedFrame& frame) {
    frame.download = {};  // of a mesh that nobody may have wanted
    frame.ranges = {};    // of that mesh, not of the next
    free_frames_.put(&frame);
}

void EncodingThread::perform(Encode& task) {
    --frames_waiting_;
    Upload& upload = *task.upload;
    // Also when nobody reads any more: the frame was received, and watchers get it.
    wait_for_room(upload);
    auto& last_finished = upload.run->last_finished;
    if (last_finished && task.frame->index <= *last_finished) return answer_again(task);
    last_finished = task.frame->index;
    if (newest_ != nullptr) give_back(*newest_);
    newest_ = task.frame;
    Encodings before = watchers_.replace_meshes();
    before.merge(before_);  // older ones, of formats that have skipped frames
    before_ = std::move(before);
    try {
        if (upload.options.receive_meshes) {
            const MeshFormat format = stream_format(upload.options, context_.settings);
            const auto encoded = encode_newest(
                format, [&](const SharedMessage& message) { upload.output.push_to(0, message); }, upload.options.spray);
            // Before the end, so that a simulator with an answer finds its figures.
            count_answer(encoded->statistics);
            upload.output.push(encoded->end);
            watchers_.publish(format, encoded, Watchers::Keep::until_the_next_frame);
        } else {
            const FrameStatistics statistics = statistics_of(*newest_);
            count_answer(statistics);
            upload.output.push(serialize(statistics));
        }
    } catch (const DeviceError&) {
        throw;
    } catch (...) {
        ends_.upload(task.upload, std::current_exception());
    }
    answered(upload);
    for (const auto& observer : context_.observers) encode_for(*observer);
    // One whatever waits, so that each format has its turn.
    encode_in_one_format();
    encode_for_watchers();
}

void EncodingThread::answer_again(Encode& task) {
    Upload& upload = *task.upload;
    try {
        if (upload.options.receive_meshes)
            upload.output.push(encode_frame(
                                   *task.frame, stream_format(upload.options, context_.settings), nullptr,
                                   *context_.shared.workers, scratch_,
                                   [&](const SharedMessage& message) { upload.output.push_to(0, message); },
                                   upload.options.spray)
                                   ->end);
        else
            upload.output.push(serialize(statistics_of(*task.frame)));
    } catch (const DeviceError&) {
        throw;
    } catch (...) {
        ends_.upload(task.upload, std::current_exception());
    }
    answered(upload);
    give_back(*task.frame);
    encode_for_watchers();
}

void EncodingThread::wait_for_room(Upload& upload) {
    while (!upload.output.has_room() && encode_in_one_format()) {
    }
    upload.output.wait_for_room();
}

void EncodingThread::perform(ReportDrop& task) {
    Upload& upload = *task.upload;
    wait_for_room(upload);
    if (const auto part = task.dropped.part)
        upload.output.push_to(*part, frame_dropped_message(task.dropped));
    else
        upload.output.push(frame_dropped_message(task.dropped));
    upload.unreported_drops.report();
    answered(upload);
}

void EncodingThread::perform(EndUpload& task) {
    ends_.upload(task.upload, task.error);
}

void EncodingThread::perform(EndSession& task) {
    ends_.session(task.error);
}

void EncodingThread::perform(EncodeForWatchers&) {
    looks_for_watchers_ = false;  // first: watchers that come from here on may be overlooked
    encode_for_watchers();
}

void EncodingThread::perform(AddCapped& task) {
    // A newer frame has it already: the watcher was there when that was reconstructed.
    if (newest_ == nullptr || newest_->number != task.frame_number) return;
    auto& capped = newest_->capped_at(task.max_level);
    if (!capped.made) capped.mesh = std::move(task.mesh);
    capped.made = true;
    encode_for_watchers();
}

void EncodingThread::perform(ShowAgain& task) {
    if (newest_ != nullptr) return give_back(*task.frame);
    newest_ = task.frame;
    encode_for_watchers();
}

void EncodingThread::perform(ReleaseMeshes& task) {
    if (newest_ != nullptr && task.newest == Newest::keep) newest_->download.finish();
    if (newest_ != nullptr && task.newest == Newest::release) give_back(*std::exchange(newest_, nullptr));
    for (ReconstructedFrame& frame : frames_)
        if (&frame != newest_) frame.release_memory();
    scratch_.release_memory();
    task.done->set_value();
}

bool EncodingThread::release_meshes(Newest newest) {
    auto done = std::make_shared<std::promise<void>>();
    std::future<void> released = done->get_future();
    put(ReleaseMeshes{.done = std::move(done), .newest = newest});
    try {
        released.get();
        return true;
    } catch (const std::future_error&) {  // the promise was dropped with the tasks
        return false;
    }
}

void EncodingThread::answered(Upload& upload) {
    upload.last_activity = Upload::Clock::now();
    --upload.owed;
}

void EncodingThread::count_answer(const FrameStatistics& statistics) {
    if (newest_->finished)
        context_.shared.metrics->surface_finished(statistics);
    else
        context_.shared.metrics->frame_finished(statistics);
    const std::lock_guard lock(mutex_);
    last_frame_ = statistics;
}

std::shared_ptr<const EncodedFrame> EncodingThread::encode_newest(const MeshFormat& format, const MessageSink& sink,
                                                                  bool spray_to_sink) {
    const auto before = before_.find(format);
    return encode_frame(*newest_, format, before != before_.end() ? before->second.get() : nullptr,
                        *context_.shared.workers, scratch_, sink, spray_to_sink);
}

void EncodingThread::encode_for_watchers() {
    // Each format once: a watcher that comes meanwhile has put a task behind the others.
    std::size_t formats = watchers_.unpublished_formats().size();
    while (formats-- > 0 && frames_waiting_ == 0 && encode_in_one_format()) {
    }
    const auto awaited = watchers_.unpublished_formats();
    std::erase_if(before_, [&](const auto& entry) { return !awaited.contains(entry.first); });
}

bool EncodingThread::encode_in_one_format() {
    if (newest_ == nullptr) return false;
    try {
        const auto format =
            watchers_.next_unpublished_format([&](int max_level) { return newest_->mesh_at(max_level) != nullptr; });
        if (format) watchers_.publish(*format, encode_newest(*format, nullptr));
        return format.has_value();
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = context_.identity.id, .frame = newest_->index},
                  "not encoded for its watchers, who keep the frame before: {}", error.what());
        return false;
    }
}

void EncodingThread::encode_for(SessionObserver& observer) {
    const std::vector<AttributeWish> all{{.name = {}, .bits = observer.attribute_bits()}};
    const MeshFormat format = stream_format(SessionObserver::normal_bits, observer.codec(), all, context_.settings);
    std::shared_ptr<const EncodedFrame> frame = watchers_.published(format);
    try {
        if (!frame)
            watchers_.publish(format, frame = encode_newest(format, nullptr), Watchers::Keep::until_the_next_frame);
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = context_.identity.id, .frame = newest_->index}, "not encoded for its {}: {}",
                  observer.product(), error.what());
        return;
    }
    observer.encoded(std::move(frame));
}

}  // namespace meniscus::server
