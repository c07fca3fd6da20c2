#include "sessions/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/seconds.hpp"
#include "process/call_log.hpp"
#include "process/log.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"
#include "sessions/sending/stream_notices.hpp"
#include "sessions/watching/watcher_limits.hpp"

namespace meniscus::server {

Session::Session(SessionIdentity identity, const Settings& settings, const Limits& limits,
                 ReconstructFunctions functions, SharedResources shared, SessionObservers observers)
    : context_{.identity = std::move(identity),
               .settings = settings,
               .limits = limits,
               .shared = std::move(shared),
               .observers = std::move(observers),
               .closing = closing_.get_token()},
      in_flight_(
          std::make_shared<SessionInFlight>(SessionInFlight{.name = account() ? account()->in_flight() : nullptr})),
      inputs_(std::make_shared<MemoryAccount>(limits.bytes_per_session), context_.shared.bytes_in_flight, in_flight_,
              context_.shared.memory, context_.shared.pinning),
      send_ahead_(functions.send_ahead),
      frame_stop_(functions.stop, context_.shared.deadlines, limits.frame_time),
      frame_rate_(limits.frames_per_second),
      encoding_(context_, watchers_,
                {.upload = [this](const auto& upload, auto error) { finish_upload(upload, std::move(error)); },
                 .session = [this](const std::exception_ptr& error) { end(error); }}),
      reconstructing_(context_, std::move(functions), received_, inputs_, watchers_, encoding_, frame_stop_) {}

Session::~Session() {
    close();
    join();
}

SessionState Session::state() const {
    SessionState state;
    state.last_frame = encoding_.last_frame();
    // After it, so that the frame answered last is among those that are counted.
    const ReconstructingThread::Progress reconstructed = reconstructing_.progress();
    state.frames = reconstructed.frames;
    state.last_frame_index = reconstructed.last_frame_index;
    const Watchers::Progress watchers = watchers_.progress();
    state.watchers = watchers.watchers;
    state.frames_skipped = watchers.frames_skipped;
    state.watcher_lag = watchers.lag;
    const std::lock_guard lock(mutex_);
    state.uploading = upload_ != nullptr;
    if (reconstructing_.waits_for_turn()) {
        state.wait = SessionWait::device;
        state.waits_for = context_.shared.turns->holder();
    } else if (upload_ && upload_->pace.paused()) {
        state.wait = SessionWait::bytes_in_flight;
    }
    state.frames_dropped_replaced = dropped_replaced_;
    state.frames_dropped_not_nth = dropped_not_nth_;
    return state;
}

std::string Session::instance() const {
    using std::chrono::microseconds;
    const auto created = std::chrono::duration_cast<microseconds>(created_at_.time_since_epoch());
    const std::lock_guard lock(mutex_);
    return fmt::format("{:x}.{}", created.count(), runs_);
}

void Session::open_upload(const std::shared_ptr<Upload>& upload) {
    std::shared_ptr<Upload> before;
    std::vector<InputFrame*> withdrawn;
    std::vector<std::shared_ptr<Watch>> disappointed;
    {
        const std::lock_guard lock(mutex_);
        if (closed_) throw session_ended(id(), end_reason_);
        if (draining_) throw shutting_down();
        upload->run = run_of(upload->options);
        if (upload_ && upload->run != run_)
            throw Refusal(Refusal::Kind::failed_precondition,
                          fmt::format("another stream uploads to session {}", id()));
        accepted_.accept(upload->options.frames, id());
        disappointed = watchers_.list();
        std::erase_if(disappointed, [this](const auto& watch) { return accepted_.can_show(watch->options()); });
        before = upload_;
        orphaned_ = false;
        awaited_for_ = {};
        set_upload(upload);
        if (run_ != upload->run) ++runs_;
        run_ = upload->run;
        unanswered_.push_back(upload);
        last_upload_ = upload.get();
        if (before) withdrawn = received_.withdraw(*before);
    }
    for (InputFrame* input : withdrawn) inputs_.give_back(*input);
    for (const auto& watch : disappointed)
        watch->finish(std::make_exception_ptr(AcceptedFrames::needs_particles(id())));
    if (before)
        before->output.abort(std::make_exception_ptr(
            Refusal(Refusal::Kind::failed_precondition,
                    fmt::format("another stream has resumed run {:016x} of session {}", before->run->id, id()))));
    inputs_.lend_third();
}

std::shared_ptr<Run> Session::run_of(const UploadOptions& options) const {
    if (run_ && options.run_id != 0 && run_->id == options.run_id) return run_;
    auto run = std::make_shared<Run>();
    run->id = options.run_id;
    return run;
}

void Session::set_upload(std::shared_ptr<Upload> upload) {
    upload_ = std::move(upload);
    inputs_.allow_third(upload_ && upload_->options.policy == UploadPolicy::latest);
}

void Session::admit_frame(std::uint64_t index) {
    const std::lock_guard lock(mutex_);
    if (!frame_rate_.take(std::chrono::steady_clock::now()))
        throw LimitReached(
            LimitName::frames_per_second,
            fmt::format("frame {}: more than {} frames in a second; the server takes at most {} frames per "
                        "second of a session",
                        index, limits().frames_per_second, limits().frames_per_second));
    if (account() && !account()->take_frame(std::chrono::steady_clock::now()))
        throw LimitReached(
            LimitName::frames_per_second_per_name,
            fmt::format("frame {}: more than {} frames in a second over all sessions of {}; that is its share", index,
                        account()->shares().frames_per_second, account()->name()));
}

void Session::submit(std::shared_ptr<Upload> upload, InputFrame& input) {
    std::vector<InputFrame*> unused;
    // Nobody else sees the frame yet.
    if (send_ahead_ && upload->options.frames == FrameKind::particles && is_to_be_reconstructed(upload)) {
        // One frame at a time is sent: not the one that this one replaces.
        if (upload->options.policy == UploadPolicy::latest) received_.sent_ahead(*upload).clear();
        input.send_ahead(send_ahead_);
    }
    {
        const std::lock_guard lock(mutex_);
        // Otherwise the session has ended the upload, or another stream has resumed its run and sends this frame too.
        if (upload_ == upload)
            unused = enqueue(std::move(upload), input);
        else
            unused.push_back(&input);
    }
    for (InputFrame* each : unused) inputs_.give_back(*each);
}

void Session::report_incomplete(std::shared_ptr<Upload> upload, std::uint32_t part, std::uint64_t index) {
    const std::lock_guard lock(mutex_);
    if (upload_ != upload) return;
    ++upload->owed;
    upload->unreported_drops.add();
    context_.shared.metrics->frame_dropped(DropReason::incomplete);
    received_.put({.upload = std::move(upload),
                   .dropped = DroppedFrame{.index = index, .reason = DropReason::incomplete, .part = part}});
}

bool Session::is_to_be_reconstructed(const std::shared_ptr<Upload>& upload) const {
    const std::lock_guard lock(mutex_);
    const UploadOptions& options = upload->options;
    return upload_ == upload && (options.policy != UploadPolicy::every_nth || upload->submitted % options.nth == 0);
}

std::vector<InputFrame*> Session::enqueue(std::shared_ptr<Upload> upload, InputFrame& input) {
    const UploadOptions& options = upload->options;
    const std::uint64_t position = upload->submitted++;
    ++upload->owed;
    context_.shared.metrics->frame_received(input.bytes.size());
    if (options.policy == UploadPolicy::every_nth && position % options.nth != 0) {
        upload->unreported_drops.add();
        ++dropped_not_nth_;
        context_.shared.metrics->frame_dropped(DropReason::not_nth);
        received_.put({.upload = std::move(upload),
                       .dropped = DroppedFrame{.index = input.index, .reason = DropReason::not_nth}});
        return {&input};
    }
    std::vector<InputFrame*> replaced;
    if (options.policy == UploadPolicy::latest) replaced = received_.replace(*upload);
    dropped_replaced_ += replaced.size();
    for (std::size_t i = 0; i < replaced.size(); ++i) context_.shared.metrics->frame_dropped(DropReason::replaced);
    received_.put({.upload = std::move(upload), .input = &input});
    return replaced;
}

void Session::end_upload(std::shared_ptr<Upload> upload, std::exception_ptr error) {
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == upload) set_upload(nullptr);
    }
    received_.put({.upload = std::move(upload), .error = std::move(error)});
}

void Session::cancel_upload(const std::shared_ptr<Upload>& upload, UploadEnd end) {
    {
        const std::lock_guard lock(mutex_);
        // Not only while it sends: it may have been taken for one that has ended.
        if (end == UploadEnd::vanished && last_upload_ == upload.get()) orphaned_ = true;
        // One that looked as if it had ended well may have been broken off all the same.
        if (last_upload_ == upload.get() && !upload->canceled && (end != UploadEnd::answered || has_stream())) {
            without_stream_since_ = std::chrono::steady_clock::now();
            awaited_for_ = end == UploadEnd::answered ? std::chrono::milliseconds(0) : upload->options.reconnect;
        }
        upload->canceled = true;
    }
    upload->output.close();
    for (InputFrame* input : received_.withdraw(*upload)) inputs_.give_back(*input);
    frame_stop_.cancel(*upload);
    end_upload(upload, nullptr);
}

std::shared_ptr<Watch> Session::open_watch(const WatchOptions& options, std::function<void()> wake,
                                           const std::shared_ptr<const NameAccount>& watcher) {
    auto watch = std::make_shared<Watch>(options, std::move(wake), context_.shared.metrics, watcher);
    const std::lock_guard lock(mutex_);
    if (closed_) throw session_ended(id(), end_reason_);
    if (draining_) throw shutting_down();
    if (!accepted_.can_show(options)) throw AcceptedFrames::needs_particles(id());
    if (!options.once) {
        require_room_for(options, watcher.get(), watchers_.list(), id(), limits());
    } else if (reconstructing_.progress().frames == 0) {
        watch->finish(nullptr);
        return watch;
    }
    if (watchers_.add(watch)) return watch;
    if (!options.max_particles) encoding_.look_for_watchers();
    received_.put({.watchers = true});
    return watch;
}

void Session::close_watch(const std::shared_ptr<Watch>& watch) {
    const std::lock_guard lock(mutex_);
    watchers_.remove(watch);
    if (!watch->options().once) last_used_ = last_attended_ = std::chrono::steady_clock::now();
}

void Session::finish_upload(const std::shared_ptr<Upload>& upload, std::exception_ptr error) {
    std::vector<std::shared_ptr<Watch>> done;
    bool moves = false;
    {
        const std::lock_guard lock(mutex_);
        if (upload_ == upload) set_upload(nullptr);
        last_used_ = last_attended_ = std::chrono::steady_clock::now();
        if (std::erase(unanswered_, upload) != 0 && !upload->canceled) {
            without_stream_since_ = last_used_;
            // An earlier stream may end last: its connection was noticed to be dead after a later one had broken, too.
            if (last_upload_ == upload.get()) awaited_for_ = {};
        }
        if (draining_ && !upload_) done = watchers_.list();
        // Another run may have come since, and is here still or waits for answers.
        moves = upload && upload->moves && !upload_ &&
                std::ranges::all_of(unanswered_, [&](const auto& other) { return other->run == upload->run; });
    }
    if (moves) {
        call_log.write({.session = id()}, "its simulator goes on with another server");
        end(std::make_exception_ptr(moved()));
    }
    // Only now: the stream that learns of the end may open the next one.
    if (upload) upload->output.finish(std::move(error));
    for (const auto& watch : done) watch->finish(std::make_exception_ptr(shutting_down()));
}

void Session::end(const std::exception_ptr& error) {
    const Attached attached = detach();
    for (const auto& upload : attached.uploads) {
        upload->output.finish(error);
        upload->stop(error);
    }
    for (const auto& watch : attached.watches) watch->finish(error);
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
        watches = watchers_.list();
    }
    for (const auto& each : uploads) each->output.push(draining_message(grace));
    for (const auto& watch : watches) watch->announce_end(grace);
    if (upload)
        upload->drain();
    else  // behind the frames of an upload that has ended already
        received_.put({});
}

void Session::end_slow_upload(std::chrono::steady_clock::time_point now) {
    std::shared_ptr<Upload> slow;
    std::optional<UploadPace::Slow> frame;
    {
        const std::lock_guard lock(mutex_);
        if (upload_ && (frame = upload_->pace.too_slow(limits().least_pace, now))) slow = upload_;
    }
    if (slow)
        slow->stop(std::make_exception_ptr(
            LimitReached(LimitName::upload_time,
                         fmt::format("frame {}: {} of {} bytes in {:.3g} s; a frame must be there within {:.3g} s, or "
                                     "come with {} bytes per "
                                     "second from then on",
                                     frame->index, frame->arrived, frame->announced, frame->time.count(),
                                     seconds_of(limits().least_pace.time), limits().least_pace.bytes_per_second))));
}

void Session::end_stalled_uploads(std::chrono::steady_clock::time_point now, bool memory_is_short) {
    const LeastPace& least = limits().least_pace;
    const bool keeps_others_waiting = memory_is_short || context_.shared.bytes_in_flight->others_wait(*in_flight_);
    if (least.time.count() == 0 || !keeps_others_waiting) return;
    std::vector<std::shared_ptr<Upload>> unanswered;
    {
        const std::lock_guard lock(mutex_);
        unanswered = unanswered_;
    }
    for (const auto& upload : unanswered) {
        const auto stall = upload->output.too_slow(least, now);
        if (!stall) continue;
        log_warning({.session = id()},
                    "its simulator has taken {} bytes in {:.3g} s, while there is no room for frames of other "
                    "sessions: the stream ends",
                    stall->bytes_taken, stall->time.count());
        const auto error = std::make_exception_ptr(LimitReached(
            LimitName::answer_time,
            fmt::format("{} bytes of the meshes were taken in {:.3g} s, while there is no room for frames of other "
                        "sessions; take the first within {:.3g} s, or {} bytes per second from then on",
                        stall->bytes_taken, stall->time.count(), seconds_of(least.time), least.bytes_per_second)));
        // First, as nobody may ever take what waits.
        upload->output.abort(error);
        cancel_upload(upload, UploadEnd::vanished);
        upload->stop(error);
    }
}

void Session::end_idle_upload(std::chrono::steady_clock::time_point now, bool memory_is_short) {
    end_slow_upload(now);
    end_stalled_uploads(now, memory_is_short);
    std::shared_ptr<Upload> idle;
    {
        const std::lock_guard lock(mutex_);
        if (!upload_ || upload_->owed != 0 || upload_->pace.paused()) return;
        if (upload_->missing_parts == 0 && upload_->waits_for_parts) return;
        const auto orphan_time = upload_->missing_parts != 0 ? limits().orphan_time : std::chrono::milliseconds(0);
        const auto time = orphan_time.count() != 0 ? orphan_time : limits().idle_time;
        if (time.count() == 0 || now - upload_->last_activity.load() < time) return;
        idle = upload_;
        if (idle->missing_parts != 0) orphaned_ = true;
        set_upload(nullptr);
    }
    if (idle->missing_parts != 0)
        idle->output.finish(std::make_exception_ptr(Refusal(
            Refusal::Kind::failed_precondition,
            fmt::format("{} of the {} parts of the frames have not come for {:.3g} s", idle->missing_parts.load(),
                        idle->options.parts, seconds_of(now - idle->last_activity.load())))));
    else
        idle->output.finish(std::make_exception_ptr(IdleStream(
            fmt::format("nothing has arrived for {:.3g} s; the server keeps an idle stream for {:.3g} s: open another "
                        "when there are frames",
                        seconds_of(now - idle->last_activity.load()), seconds_of(limits().idle_time)))));
}

std::optional<std::string> Session::unused(std::chrono::steady_clock::time_point now) const {
    using Clock = std::chrono::steady_clock;
    const std::lock_guard lock(mutex_);
    if (upload_) return std::nullopt;
    if (auto reason = unused_as_ephemeral(now)) return reason;
    if (!unanswered_.empty() || watchers_.count() != 0) return std::nullopt;
    const auto reaches = [&](Clock::time_point since, Clock::duration time) {
        return time.count() != 0 && now - since >= time;
    };
    if (orphaned_ && reaches(last_attended_, limits().orphan_time))
        return "its simulator vanished, and nobody has watched or resumed it since";
    if (!reaches(last_used_, limits().idle_time)) return std::nullopt;
    return fmt::format("nobody has used it for {:.3g} s", seconds_of(limits().idle_time));
}

std::optional<std::string> Session::unused_as_ephemeral(std::chrono::steady_clock::time_point now) const {
    if (!kind().ephemeral || has_stream()) return std::nullopt;
    const auto orphan_time = limits().orphan_time;
    const auto awaited_for = orphan_time.count() == 0 ? awaited_for_ : std::min(awaited_for_, orphan_time);
    const auto kept_for = std::max(limits().ephemeral_time, awaited_for);
    if (now - without_stream_since_ < kept_for) return std::nullopt;
    return fmt::format("{}, and no stream has come for {:.3g} s",
                       orphaned_ ? "its simulator vanished" : "it is ephemeral", seconds_of(kept_for));
}

bool Session::has_stream() const {
    // The frames of one that was canceled are still being stopped.
    return upload_ || std::ranges::any_of(unanswered_, [](const auto& upload) { return !upload->canceled; });
}

std::optional<std::chrono::steady_clock::duration> Session::without_stream(
    std::chrono::steady_clock::time_point now) const {
    const std::lock_guard lock(mutex_);
    if (has_stream()) return std::nullopt;
    // A stream may have ended since `now`.
    return std::max(now - without_stream_since_, std::chrono::steady_clock::duration::zero());
}

std::future<void> Session::release_buffers() {
    auto done = std::make_shared<std::promise<void>>();
    std::future<void> released = done->get_future();
    received_.put({.release = std::move(done)});
    return released;
}

void Session::touch() {
    const std::lock_guard lock(mutex_);
    last_used_ = std::chrono::steady_clock::now();
}

void Session::await_stream() {
    const std::lock_guard lock(mutex_);
    without_stream_since_ = last_attended_ = std::chrono::steady_clock::now();
}

void Session::close(std::string reason) {
    const auto error = std::make_exception_ptr(session_ended(id(), reason));
    const Attached attached = detach(std::move(reason));
    for (const auto& upload : attached.uploads) {
        upload->output.abort(error);
        upload->stop(error);
    }
    for (const auto& watch : attached.watches) watch->finish(watch->options().once ? error : nullptr);
}

Session::Attached Session::detach(std::string reason) {
    Attached attached;
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(closed_, true)) return attached;
        end_reason_ = std::move(reason);
        set_upload(nullptr);
        attached.uploads.swap(unanswered_);
        attached.watches = watchers_.list();
    }
    inputs_.close();
    for (InputFrame* input : received_.close()) inputs_.give_back(*input);
    encoding_.close();
    frame_stop_.close();
    closing_.request_stop();
    return attached;
}

bool Session::ended() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

std::string Session::end_reason() const {
    const std::lock_guard lock(mutex_);
    return end_reason_;
}

void Session::join() {
    reconstructing_.join();
    encoding_.join();
    for (const auto& observer : context_.observers) observer->ended();
    // Not with the last reference: a call that its client keeps open may have that for long.
    encoding_.release_memory();
    reconstructing_.release_memory();
    inputs_.release_memory();
}

}  // namespace meniscus::server
