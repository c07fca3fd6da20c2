#include "sessions/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "log.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/refusal.hpp"
#include "sessions/stream_notices.hpp"

namespace meniscus::server {

namespace {

Refusal shutting_down() {
    return {Refusal::Kind::unavailable, "the server is shutting down"};
}

/// The one that a watcher with the stream's wishes shares.
MeshFormat stream_format(const UploadOptions& options, const Settings& settings) {
    return {.max_level = 3,
            .position_bits = static_cast<int>(offset_bits(settings)),
            .normal_bits = settings.normals ? options.normal_bits : 0};
}

}  // namespace

Session::Session(std::string id, const Settings& settings, const Limits& limits, Reconstruct reconstruct,
                 std::shared_ptr<WorkerPool> workers, std::string owner, std::shared_ptr<Metrics> metrics,
                 EmitCapped emit_capped, std::shared_ptr<SessionObserver> observer, SharedResources shared)
    : id_(std::move(id)),
      owner_(std::move(owner)),
      settings_(settings),
      limits_(limits),
      workers_(std::move(workers)),
      reconstruct_(std::move(reconstruct)),
      metrics_(std::move(metrics)),
      emit_capped_(std::move(emit_capped)),
      observer_(std::move(observer)),
      shared_(std::move(shared)),
      inputs_([&] {
          const auto account = std::make_shared<MemoryAccount>(limits.bytes_per_session);
          const auto& in_flight = shared_.bytes_in_flight;
          return std::array<InputFrame, 3>{InputFrame(account, in_flight), InputFrame(account, in_flight),
                                           InputFrame(account, in_flight)};
      }()),
      frame_rate_(limits.frames_per_second) {
    for (std::size_t i = 0; i + 1 < inputs_.size(); ++i) free_inputs_.give(inputs_[i]);
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
    for (const auto& watch : watches_) {
        const Watch::Progress progress = watch->progress();
        state.frames_skipped += progress.frames_skipped;
        state.watcher_lag = std::max<std::chrono::duration<double>>(state.watcher_lag, progress.lag);
    }
    return state;
}

std::shared_ptr<Upload> Session::open_upload(const UploadOptions& options, std::function<void()> wake,
                                             std::function<void()> drain) {
    auto upload = std::make_shared<Upload>(options, std::move(wake), std::move(drain));
    std::shared_ptr<Upload> before;
    std::vector<InputFrame*> withdrawn;
    bool give_third_input = false;
    {
        const std::lock_guard lock(mutex_);
        if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_));
        if (draining_) throw shutting_down();
        upload->run = run_of(options);
        if (upload_ && upload->run != run_)
            throw Refusal(Refusal::Kind::failed_precondition, fmt::format("another stream uploads to session {}", id_));
        before = std::exchange(upload_, upload);
        run_ = upload->run;
        unanswered_.push_back(upload);
        if (options.policy == UploadPolicy::latest) give_third_input = !std::exchange(third_input_in_use_, true);
        if (before) withdrawn = received_.withdraw(*before);
    }
    for (InputFrame* input : withdrawn) return_input(*input);
    if (before) {
        before->output.abort(std::make_exception_ptr(
            Refusal(Refusal::Kind::failed_precondition,
                    fmt::format("another stream has resumed run {:016x} of session {}", before->run->id, id_))));
    }
    if (give_third_input) free_inputs_.give(inputs_.back());
    return upload;
}

std::shared_ptr<Run> Session::run_of(const UploadOptions& options) const {
    if (run_ && options.run_id != 0 && run_->id == options.run_id) return run_;
    return std::make_shared<Run>(Run{.id = options.run_id});
}

void Session::request_input(SlotPool<InputFrame>::Waiter waiter) {
    free_inputs_.request(std::move(waiter));
}

void Session::return_input(InputFrame& input) {
    input.land();
    if (&input == &inputs_.back()) {
        const std::lock_guard lock(mutex_);
        if (!upload_ || upload_->options.policy != UploadPolicy::latest) {
            third_input_in_use_ = false;
            return;
        }
    }
    free_inputs_.give(input);
}

void Session::admit_frame(std::uint64_t index) {
    const std::lock_guard lock(mutex_);
    if (!frame_rate_.take(std::chrono::steady_clock::now()))
        throw LimitExceeded(fmt::format("frame {}: more than {} frames in a second; the server takes at most {} frames per "
                                        "second of a session",
                                        index, limits_.frames_per_second, limits_.frames_per_second));
}

void Session::submit(std::shared_ptr<Upload> upload, InputFrame& input) {
    std::vector<InputFrame*> unused;
    {
        const std::lock_guard lock(mutex_);
        // Otherwise the session has ended the upload, or another stream has resumed its run and sends this frame too.
        if (upload_ == upload)
            unused = enqueue(std::move(upload), input);
        else
            unused.push_back(&input);
    }
    for (InputFrame* each : unused) return_input(*each);
}

std::vector<InputFrame*> Session::enqueue(std::shared_ptr<Upload> upload, InputFrame& input) {
    const UploadOptions& options = upload->options;
    const std::uint64_t position = upload->submitted++;
    ++upload->owed;
    metrics_->frame_received(input.bytes.size());
    if (options.policy == UploadPolicy::every_nth && position % options.nth != 0) {
        upload->unreported_drops.add();
        ++state_.frames_dropped_not_nth;
        metrics_->frame_dropped(Metrics::Drop::not_nth);
        received_.put({.upload = std::move(upload),
                       .dropped = DroppedFrame{.index = input.index, .reason = DropReason::not_nth}});
        return {&input};
    }
    std::vector<InputFrame*> replaced;
    if (options.policy == UploadPolicy::latest) replaced = received_.replace(*upload);
    state_.frames_dropped_replaced += replaced.size();
    for (std::size_t i = 0; i < replaced.size(); ++i) metrics_->frame_dropped(Metrics::Drop::replaced);
    received_.put({.upload = std::move(upload), .input = &input});
    return replaced;
}

void Session::end_upload(std::shared_ptr<Upload> upload, std::exception_ptr error) {
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == upload) upload_.reset();
    }
    received_.put({.upload = std::move(upload), .error = std::move(error)});
}

void Session::cancel_upload(const std::shared_ptr<Upload>& upload) {
    upload->output.close();
    for (InputFrame* input : received_.withdraw(*upload)) return_input(*input);
    end_upload(upload, nullptr);
}

std::shared_ptr<Watch> Session::open_watch(const WatchWishes& wishes, std::function<void()> wake) {
    auto watch = std::make_shared<Watch>(wishes, std::move(wake), metrics_);
    const std::lock_guard lock(mutex_);
    if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_));
    if (draining_) throw shutting_down();
    if (limits_.watchers_per_session != 0 && watches_.size() >= limits_.watchers_per_session)
        throw LimitExceeded(fmt::format("session {} has {} watchers; the server takes at most {} per session", id_,
                                        watches_.size(), limits_.watchers_per_session));
    watches_.push_back(watch);
    if (const auto found = published_.find(wishes.format); found != published_.end()) {
        watch->put(found->second);
        return watch;
    }
    tasks_.put(EncodeForWatchers{});
    if (wishes.format.max_level < 3) received_.put({.max_level = wishes.format.max_level});
    return watch;
}

void Session::close_watch(const std::shared_ptr<Watch>& watch) {
    const std::lock_guard lock(mutex_);
    if (std::erase(watches_, watch) != 0) state_.frames_skipped += watch->progress().frames_skipped;
    last_used_ = std::chrono::steady_clock::now();
}

void Session::drain(std::chrono::duration<double> grace) {
    std::shared_ptr<Upload> upload;
    std::vector<std::shared_ptr<Upload>> uploads;
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        draining_ = true;
        upload = upload_;
        uploads = unanswered_;
        watches = watches_;
    }
    for (const auto& each : uploads) each->output.push(draining_message(grace));
    for (const auto& watch : watches) watch->announce_end(grace);
    if (upload)
        upload->drain();
    else  // behind the frames of an upload that has ended already
        received_.put({});
}

bool Session::end_idle(std::chrono::steady_clock::time_point now) {
    using Seconds = std::chrono::duration<double>;
    std::shared_ptr<Upload> idle;
    {
        const std::lock_guard lock(mutex_);
        if (!upload_)
            return unanswered_.empty() && watches_.empty() && now - last_used_ >= limits_.idle_time;
        if (upload_->owed == 0 && now - upload_->last_activity.load() >= limits_.idle_time) idle = std::exchange(upload_, nullptr);
    }
    if (idle)
        idle->output.finish(std::make_exception_ptr(LimitExceeded(fmt::format(
            "nothing has arrived for {:.3g} s; the server keeps an idle stream for {:.3g} s: open another when there are frames",
            Seconds(now - idle->last_activity.load()).count(), Seconds(limits_.idle_time).count()))));
    return false;
}

void Session::touch() {
    const std::lock_guard lock(mutex_);
    last_used_ = std::chrono::steady_clock::now();
}

void Session::close() {
    const Attached attached = detach();
    const auto error = std::make_exception_ptr(
        Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id_)));
    for (const auto& upload : attached.uploads) upload->output.abort(error);
    for (const auto& watch : attached.watches) watch->finish(nullptr);
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
    for (;;) {
        const FrameQueue::Next next = received_.wait();
        if (next == FrameQueue::Next::closed) return;
        if (next == FrameQueue::Next::note) {
            if (auto note = received_.take(next)) pass_on(std::move(*note));
            continue;
        }
        if (next_mesh_ == nullptr) {
            const auto mesh = free_frames_.take();
            if (!mesh) return;
            next_mesh_ = *mesh;
        }
        const Turns::Turn turn = shared_.turns->wait();
        // Only now, so that until its turn a frame can be replaced by a newer one.
        if (auto frame = received_.take(next); frame && !reconstruct_next(std::move(*frame))) return;
    }
}

void Session::pass_on(Received note) {
    if (note.max_level != 0)
        cap_levels_again(note.max_level);
    else if (note.dropped)
        tasks_.put(ReportDrop{.upload = std::move(note.upload), .dropped = *note.dropped});
    else
        tasks_.put(EndUpload{.upload = std::move(note.upload), .error = std::move(note.error)});
}

bool Session::reconstruct_next(Received received) {
    InputFrame& input = *received.input;
    if (received.upload == failed_) {
        return_input(input);
        return true;
    }
    try {
        reconstruct(received, *next_mesh_);
    } catch (const DeviceError& error) {
        log_error({.session = id_, .frame = input.index}, "the session ends: {}", error.what());
        tasks_.put(EndSession{std::current_exception()});
        return false;
    } catch (...) {
        failed_ = received.upload;
        return_input(input);
        tasks_.put(EndUpload{.upload = failed_, .error = std::current_exception()});
        return true;
    }
    if (observer_) show_to_observer(received);
    return_input(input);
    tasks_.put(Encode{.upload = std::move(received.upload), .frame = std::exchange(next_mesh_, nullptr)});
    return true;
}

void Session::reconstruct(const Received& received, ReconstructedFrame& frame) {
    const InputFrame& input = *received.input;
    try {
        frame.statistics = reconstruct_(input.view(), frame.mesh);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", input.index, error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", input.index, error.what()));
    }
    frame.index = input.index;
    frame.run_id = received.upload->run->id;
    frame.simulation_time = input.simulation_time;
    frame.received_at = input.received_at;
    frame.number = ++reconstructed_;
    cap_levels(frame);
    const std::lock_guard lock(mutex_);
    ++state_.frames;
    state_.last_frame_index = input.index;
}

void Session::show_to_observer(const Received& received) {
    auto& last_observed = received.upload->run->last_observed;
    if (last_observed && received.input->index <= *last_observed) return;
    last_observed = received.input->index;
    observer_->reconstructed(*received.input);
}

void Session::cap_levels(ReconstructedFrame& frame) {
    for (const int max_level : {1, 2}) {
        auto& capped = frame.capped_at(max_level);
        capped.made = is_wished_for(max_level) && emit_capped(max_level, capped.mesh);
        if (!capped.made) capped.mesh = {};  // nobody's memory
    }
}

void Session::cap_levels_again(int max_level) {
    if (reconstructed_ == 0) return;
    const Turns::Turn turn = shared_.turns->wait();
    AddCapped task{.frame_number = reconstructed_, .max_level = max_level, .mesh = {}};
    try {
        if (emit_capped(max_level, task.mesh)) tasks_.put(std::move(task));
    } catch (const DeviceError& error) {
        log_error({.session = id_}, "the session ends: {}", error.what());
        tasks_.put(EndSession{std::current_exception()});
    }
}

bool Session::emit_capped(int max_level, Mesh& mesh) {
    try {
        emit_capped_(max_level, mesh);
        return true;
    } catch (const DeviceError&) {
        throw;
    } catch (const std::exception& error) {
        log_error({.session = id_}, "no mesh of levels up to {} for its watchers, who keep the one before: {}", max_level,
                  error.what());
        return false;
    }
}

bool Session::is_wished_for(int max_level) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(watches_, [&](const auto& watch) { return watch->wishes().format.max_level == max_level; });
}

void Session::encode_frames() {
    while (auto task = tasks_.take()) std::visit([this](auto& t) { perform(t); }, *task);
}

void Session::perform(Encode& task) {
    Upload& upload = *task.upload;
    // Also when nobody reads any more: the frame was received, and watchers get it.
    upload.output.wait_for_room();
    auto& last_finished = upload.run->last_finished;
    if (last_finished && task.frame->index <= *last_finished) return answer_again(task);
    last_finished = task.frame->index;
    if (newest_ != nullptr) free_frames_.put(newest_);
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
            const SharedMessage statistics = encode_statistics(*newest_);
            count_answer(statistics);
            upload.output.push(statistics);
        }
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
            encode_frame(*task.frame, stream_format(upload.options, settings_), nullptr, *workers_,
                         [&](const SharedMessage& message) { upload.output.push(message); });
        else
            upload.output.push(encode_statistics(*task.frame));
    } catch (...) {
        EndUpload end{.upload = task.upload, .error = std::current_exception()};
        perform(end);
    }
    answered(upload);
    free_frames_.put(task.frame);
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
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == task.upload) upload_.reset();
        std::erase(unanswered_, task.upload);
        last_used_ = std::chrono::steady_clock::now();
        if (draining_ && !upload_) done = watches_;
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

void Session::count_answer(const SharedMessage& statistics) {
    v1::StreamResponse response;
    response.ParseFromString(*statistics);
    metrics_->frame_finished(response.frame_statistics());
    const std::lock_guard lock(mutex_);
    state_.last_frame = std::move(*response.mutable_frame_statistics());
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
    return encode_frame(*newest_, format, before != before_.end() ? before->second.get() : nullptr, *workers_, sink);
}

void Session::publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        published_[format] = frame;
        for (const auto& watch : watches_)
            if (watch->wishes().format == format) watches.push_back(watch);
    }
    for (const auto& watch : watches) watch->put(frame);
}

void Session::encode_for_watchers() {
    if (newest_ == nullptr) return;
    try {
        while (const auto format = unpublished_format()) publish(*format, encode_newest(*format, nullptr));
    } catch (const std::exception& error) {
        log_error({.session = id_, .frame = newest_->index},
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
    } catch (const std::exception& error) {
        log_error({.session = id_, .frame = newest_->index}, "not encoded for its recording: {}", error.what());
        return;
    }
    observer_->encoded(std::move(frame));
}

std::optional<MeshFormat> Session::unpublished_format() const {
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_) {
        const MeshFormat& format = watch->wishes().format;
        if (!published_.contains(format) && newest_->mesh_at(format.max_level) != nullptr) return format;
    }
    return std::nullopt;
}

}  // namespace meniscus::server
