#include "sessions/session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/refusal.hpp"

namespace meniscus::server {

Session::Session(std::string id, const Settings& settings, const Limits& limits, Reconstruct reconstruct,
                 std::shared_ptr<WorkerPool> workers, std::string owner, std::shared_ptr<Metrics> metrics,
                 std::shared_ptr<SessionObserver> observer)
    : id_(std::move(id)),
      owner_(std::move(owner)),
      settings_(settings),
      limits_(limits),
      workers_(std::move(workers)),
      reconstruct_(std::move(reconstruct)),
      metrics_(std::move(metrics)),
      observer_(std::move(observer)),
      inputs_([&] {
          const auto account = std::make_shared<MemoryAccount>(limits.bytes_per_session);
          return std::array<InputFrame, 2>{InputFrame(account), InputFrame(account)};
      }()) {
    for (InputFrame& input : inputs_) free_inputs_.give(input);
    for (ReconstructedFrame& frame : frames_) free_frames_.put(&frame);
    reconstructing_ = std::thread([this] { reconstruct_frames(); });
    encoding_ = std::thread([this] { encode_frames(); });
}

Session::~Session() {
    close();
    join();
}

SessionState Session::state() const {
    const std::lock_guard lock(mutex_);
    SessionState state = state_;
    state.uploading = upload_ != nullptr;
    state.watchers = static_cast<std::uint32_t>(watches_.size());
    return state;
}

std::shared_ptr<Upload> Session::open_upload(const UploadOptions& options, std::function<void()> wake,
                                             std::function<void()> drain) {
    auto upload = std::make_shared<Upload>(options, std::move(wake), std::move(drain));
    const std::lock_guard lock(mutex_);
    if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_));
    if (draining_) throw Refusal(Refusal::Kind::unavailable, "the server is shutting down");
    if (upload_)
        throw Refusal(Refusal::Kind::failed_precondition, fmt::format("another stream uploads to session {}", id_));
    upload_ = upload;
    unanswered_.push_back(upload);
    return upload;
}

void Session::request_input(SlotPool<InputFrame>::Waiter waiter) {
    free_inputs_.request(std::move(waiter));
}

void Session::return_input(InputFrame& input) {
    free_inputs_.give(input);
}

void Session::submit(std::shared_ptr<Upload> upload, InputFrame& input) {
    metrics_->frame_received(input.bytes.size());
    received_.put({.upload = std::move(upload), .input = &input, .error = nullptr});
}

void Session::end_upload(std::shared_ptr<Upload> upload, std::exception_ptr error) {
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == upload) upload_.reset();
    }
    received_.put({.upload = std::move(upload), .input = nullptr, .error = std::move(error)});
}

std::shared_ptr<LatestFrame> Session::open_watch(int normal_bits, std::function<void()> wake) {
    auto slot = std::make_shared<LatestFrame>(std::move(wake));
    const std::lock_guard lock(mutex_);
    if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_));
    if (draining_) throw Refusal(Refusal::Kind::unavailable, "the server is shutting down");
    if (limits_.watchers_per_session != 0 && watches_.size() >= limits_.watchers_per_session)
        throw LimitExceeded(fmt::format("session {} has {} watchers; the server takes at most {} per session", id_,
                                        watches_.size(), limits_.watchers_per_session));
    watches_.push_back({.normal_bits = normal_bits, .slot = slot});
    if (const auto found = published_.find(normal_bits); found != published_.end())
        slot->put(found->second);
    else
        tasks_.put(EncodeForWatchers{});
    return slot;
}

void Session::close_watch(const std::shared_ptr<LatestFrame>& watch) {
    const std::lock_guard lock(mutex_);
    std::erase_if(watches_, [&](const Watch& w) { return w.slot == watch; });
}

void Session::drain() {
    std::shared_ptr<Upload> upload;
    {
        const std::lock_guard lock(mutex_);
        draining_ = true;
        upload = upload_;
    }
    if (upload)
        upload->drain();
    else  // behind the frames of an upload that has ended already
        received_.put({.upload = nullptr, .input = nullptr, .error = nullptr});
}

void Session::close() {
    const Attached attached = detach();
    const auto error = std::make_exception_ptr(
        Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_)));
    for (const auto& upload : attached.uploads) upload->output.abort(error);
    for (const Watch& watch : attached.watches) watch.slot->finish(nullptr);
}

Session::Attached Session::detach() {
    Attached attached;
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(closed_, true)) return attached;
        upload_.reset();
        attached.uploads.swap(unanswered_);
        attached.watches = watches_;
    }
    free_inputs_.close();
    received_.close();
    free_frames_.close();
    tasks_.close();
    return attached;
}

bool Session::ended() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

void Session::join() {
    if (reconstructing_.joinable()) reconstructing_.join();
    if (encoding_.joinable()) encoding_.join();
}

void Session::reconstruct_frames() {
    std::shared_ptr<Upload> failed;
    while (auto received = received_.take()) {
        if (received->input == nullptr) {
            tasks_.put(EndUpload{.upload = std::move(received->upload), .error = std::move(received->error)});
            continue;
        }
        InputFrame& input = *received->input;
        if (received->upload == failed) {
            return_input(input);
            continue;
        }
        const auto frame = free_frames_.take();
        if (!frame) return;
        try {
            reconstruct(input, **frame);
        } catch (const DeviceError& error) {
            spdlog::error("session {} ends with frame {}: {}", id_, input.index, error.what());
            tasks_.put(EndSession{std::current_exception()});
            return;
        } catch (...) {
            failed = received->upload;
            free_frames_.put(*frame);
            return_input(input);
            tasks_.put(EndUpload{.upload = failed, .error = std::current_exception()});
            continue;
        }
        if (observer_) observer_->reconstructed(input);
        return_input(input);
        tasks_.put(Encode{.upload = std::move(received->upload), .frame = *frame});
    }
}

void Session::reconstruct(const InputFrame& input, ReconstructedFrame& frame) {
    try {
        frame.statistics = reconstruct_(input.view(), frame.mesh);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", input.index, error.what()));
    }
    frame.index = input.index;
    frame.simulation_time = input.simulation_time;
    frame.received_at = input.received_at;
    const std::lock_guard lock(mutex_);
    ++state_.frames;
    state_.last_frame_index = input.index;
}

void Session::encode_frames() {
    while (auto task = tasks_.take()) std::visit([this](auto& t) { perform(t); }, *task);
}

void Session::perform(Encode& task) {
    Upload& upload = *task.upload;
    // Also when nobody reads any more: the frame was received, and watchers get it.
    upload.output.wait_for_room();
    if (newest_ != nullptr) free_frames_.put(newest_);
    newest_ = task.frame;
    {
        const std::lock_guard lock(mutex_);
        published_.clear();
    }
    try {
        if (upload.options.receive_meshes) {
            const auto encoded = encode_frame(*newest_, upload.options.normal_bits, *workers_,
                                              [&](const SharedMessage& message) { upload.output.push(message); });
            count_answer(encoded->messages.back());
            publish(upload.options.normal_bits, encoded);
        } else {
            const SharedMessage statistics = encode_statistics(*newest_);
            count_answer(statistics);
            upload.output.push(statistics);
        }
    } catch (...) {
        EndUpload end{.upload = task.upload, .error = std::current_exception()};
        perform(end);
    }
    encode_for_watchers();
    if (observer_) encode_for_observer();
}

void Session::perform(EndUpload& task) {
    std::vector<Watch> done;
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == task.upload) upload_.reset();
        std::erase(unanswered_, task.upload);
        if (draining_ && !upload_) done = watches_;
    }
    // Only now: who hears of the end may open the next stream.
    if (task.upload) task.upload->output.finish(task.error);
    for (const Watch& watch : done) watch.slot->finish(nullptr);
}

void Session::perform(EndSession& task) {
    const Attached attached = detach();
    for (const auto& upload : attached.uploads) upload->output.finish(task.error);
    for (const Watch& watch : attached.watches) watch.slot->finish(task.error);
}

void Session::perform(EncodeForWatchers&) {
    encode_for_watchers();
}

void Session::count_answer(const SharedMessage& statistics) {
    v1::StreamResponse response;
    response.ParseFromString(*statistics);
    metrics_->frame_finished(response.frame_statistics());
    const std::lock_guard lock(mutex_);
    state_.last_frame = std::move(*response.mutable_frame_statistics());
}

void Session::publish(int normal_bits, const std::shared_ptr<const EncodedFrame>& frame) {
    std::vector<std::shared_ptr<LatestFrame>> slots;
    {
        const std::lock_guard lock(mutex_);
        published_[normal_bits] = frame;
        for (const Watch& watch : watches_)
            if (watch.normal_bits == normal_bits) slots.push_back(watch.slot);
    }
    for (const auto& slot : slots) slot->put(frame);
}

void Session::encode_for_watchers() {
    if (newest_ == nullptr) return;
    try {
        while (const auto bits = unpublished_normal_bits())
            publish(*bits, encode_frame(*newest_, *bits, *workers_, nullptr));
    } catch (const std::exception& error) {
        spdlog::error("session {}: frame {} could not be encoded for its watchers, who keep the one before: {}", id_,
                      newest_->index, error.what());
    }
}

void Session::encode_for_observer() {
    constexpr int bits = SessionObserver::normal_bits;
    std::shared_ptr<const EncodedFrame> frame;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = published_.find(bits); found != published_.end()) frame = found->second;
    }
    try {
        if (!frame) publish(bits, frame = encode_frame(*newest_, bits, *workers_, nullptr));
    } catch (const std::exception& error) {
        spdlog::error("session {}: frame {} could not be encoded for its recording: {}", id_, newest_->index, error.what());
        return;
    }
    observer_->encoded(std::move(frame));
}

std::optional<int> Session::unpublished_normal_bits() const {
    const std::lock_guard lock(mutex_);
    for (const Watch& watch : watches_)
        if (!published_.contains(watch.normal_bits)) return watch.normal_bits;
    return std::nullopt;
}

}  // namespace meniscus::server
