#include "sessions/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "meniscus/error.hpp"
#include "sessions/refusal.hpp"
#include "sessions/stream_notices.hpp"

namespace meniscus::server {

Session::Session(SessionIdentity identity, const Settings& settings, const Limits& limits,
                 ReconstructFunctions functions, SharedResources shared, std::shared_ptr<SessionObserver> observer)
    : identity_(std::move(identity)),
      settings_(settings),
      limits_(limits),
      functions_(std::move(functions)),
      shared_(std::move(shared)),
      observer_(std::move(observer)),
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
        if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id()));
        if (draining_) throw shutting_down();
        upload->run = run_of(options);
        if (upload_ && upload->run != run_)
            throw Refusal(Refusal::Kind::failed_precondition,
                          fmt::format("another stream uploads to session {}", id()));
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
                    fmt::format("another stream has resumed run {:016x} of session {}", before->run->id, id()))));
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
        throw LimitExceeded(
            fmt::format("frame {}: more than {} frames in a second; the server takes at most {} frames per "
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
    shared_.metrics->frame_received(input.bytes.size());
    if (options.policy == UploadPolicy::every_nth && position % options.nth != 0) {
        upload->unreported_drops.add();
        ++state_.frames_dropped_not_nth;
        shared_.metrics->frame_dropped(Metrics::Drop::not_nth);
        received_.put({.upload = std::move(upload),
                       .dropped = DroppedFrame{.index = input.index, .reason = DropReason::not_nth}});
        return {&input};
    }
    std::vector<InputFrame*> replaced;
    if (options.policy == UploadPolicy::latest) replaced = received_.replace(*upload);
    state_.frames_dropped_replaced += replaced.size();
    for (std::size_t i = 0; i < replaced.size(); ++i) shared_.metrics->frame_dropped(Metrics::Drop::replaced);
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
    auto watch = std::make_shared<Watch>(wishes, std::move(wake), shared_.metrics);
    const std::lock_guard lock(mutex_);
    if (closed_) throw Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id()));
    if (draining_) throw shutting_down();
    if (limits_.watchers_per_session != 0 && watches_.size() >= limits_.watchers_per_session)
        throw LimitExceeded(fmt::format("session {} has {} watchers; the server takes at most {} per session", id(),
                                        watches_.size(), limits_.watchers_per_session));
    watches_.push_back(watch);
    if (wishes.max_particles) {
        if (const auto found = particles_.find(*wishes.max_particles); found != particles_.end())
            watch->put(found->second);
        else
            received_.put({.particles = true});
        return watch;
    }
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
    const auto& wish = watch->wishes().max_particles;
    if (wish &&
        std::ranges::none_of(watches_, [&](const auto& other) { return other->wishes().max_particles == wish; }))
        particles_.erase(*wish);
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
        if (!upload_) return unanswered_.empty() && watches_.empty() && now - last_used_ >= limits_.idle_time;
        if (upload_->owed == 0 && now - upload_->last_activity.load() >= limits_.idle_time)
            idle = std::exchange(upload_, nullptr);
    }
    if (idle)
        idle->output.finish(std::make_exception_ptr(LimitExceeded(
            fmt::format("nothing has arrived for {:.3g} s; the server keeps an idle stream for {:.3g} s: open another "
                        "when there are frames",
                        Seconds(now - idle->last_activity.load()).count(), Seconds(limits_.idle_time).count()))));
    return false;
}

void Session::touch() {
    const std::lock_guard lock(mutex_);
    last_used_ = std::chrono::steady_clock::now();
}

void Session::close() {
    const Attached attached = detach();
    const auto error =
        std::make_exception_ptr(Refusal(Refusal::Kind::not_found, fmt::format("session {} was deleted", id())));
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

}  // namespace meniscus::server
