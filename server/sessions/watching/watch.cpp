#include "sessions/watching/watch.hpp"

#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

namespace {

/// Finds the messages of a frame, against the mesh that was sent before.
struct Update {
    FrameUpdate operator()(const std::shared_ptr<const EncodedFrame>& frame) const {
        return update_mesh(*frame, options, base);
    }
    FrameUpdate operator()(const std::shared_ptr<const ParticleMessages>& frame) const {
        return {.messages = {frame->messages.begin(), frame->messages.end()}, .bytes = frame->bytes};
    }

    const WatchOptions& options;
    const WatcherMesh* base;
};

}  // namespace

Watch::Watch(const WatchOptions& options, std::function<void()> wake, std::shared_ptr<Metrics> metrics,
             std::shared_ptr<const NameAccount> account)
    : options_(options), wake_(std::move(wake)), metrics_(std::move(metrics)), account_(std::move(account)) {
    if (options_.bytes_per_second != 0) bucket_.emplace(options_.bytes_per_second, Clock::now());
}

void Watch::put(WatchedFrame frame, Clock::time_point now) {
    std::optional<WatchedFrame> replaced(std::move(frame));
    bool wake = false;
    std::uint64_t skipped = 0;
    std::deque<SharedMessage> given_up;  // destroyed outside of the lock, as is the frame that was replaced
    {
        const std::lock_guard lock(mutex_);
        if (finished_) return;
        if (newest_)
            ++skipped;
        else
            newest_since_ = now;
        newest_.swap(replaced);
        finished_ = options_.once;
        if (!behind_since_) behind_since_ = now;
        if (!update_.messages.empty() && writing_since_ && now - *writing_since_ > stalled_after) {
            given_up.swap(update_.messages);
            ++skipped;
        }
        skipped_ += skipped;
        if (waits_ == Waits::for_a_frame) {
            waits_ = Waits::no;
            wake = true;
        }
    }
    for (; skipped > 0; --skipped) metrics_->frame_skipped();
    if (wake) wake_();
}

void Watch::announce_end(std::chrono::duration<double> grace) {
    v1::WatchResponse response;
    response.mutable_draining()->set_seconds(grace.count());
    auto message = std::make_shared<const std::string>(response.SerializeAsString());
    bool wake = false;
    {
        const std::lock_guard lock(mutex_);
        if (finished_) return;
        draining_ = std::move(message);
        wake = std::exchange(waits_, Waits::no) != Waits::no;
    }
    if (wake) wake_();
}

void Watch::finish(std::exception_ptr error) {
    {
        const std::lock_guard lock(mutex_);
        if (finished_) return;
        finished_ = true;
        error_ = std::move(error);
        waits_ = Waits::no;
    }
    wake_();
}

bool Watch::is_finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

Watch::Progress Watch::progress(Clock::time_point now) const {
    const std::lock_guard lock(mutex_);
    return {.frames_skipped = skipped_, .lag = behind_since_ ? now - *behind_since_ : Clock::duration::zero()};
}

Watch::Next Watch::take(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    waits_ = Waits::no;
    writing_since_.reset();
    if (std::exchange(ending_, false)) metrics_->watcher_lag(std::chrono::duration<double>(now - received_at_).count());
    if (draining_) {
        writing_since_ = now;
        return std::exchange(draining_, nullptr);
    }
    if (!update_.messages.empty()) return next_message(now);
    if (!newest_) {
        if (finished_) return End{error_};
        waits_ = Waits::for_a_frame;
        return Nothing{};
    }
    if (bucket_ && !finished_) {
        const Clock::time_point at = bucket_->ready_at(now);
        if (at > now) {
            waits_ = Waits::for_the_rate;
            return Later{at};
        }
    }
    update_ = std::visit(Update{options_, sent_ ? &*sent_ : nullptr}, *newest_);
    received_at_ = std::visit([](const auto& frame) { return frame->received_at; }, *newest_);
    newest_.reset();
    if (bucket_) bucket_->spend(update_.bytes, now);
    return next_message(now);
}

/// With the lock held.
SharedMessage Watch::next_message(Clock::time_point now) {
    SharedMessage message = std::move(update_.messages.front());
    update_.messages.pop_front();
    writing_since_ = now;
    if (update_.messages.empty()) {
        ending_ = true;
        sent_ = std::move(update_.result);
        behind_since_.reset();
        if (newest_) behind_since_ = newest_since_;
    }
    return message;
}

}  // namespace meniscus::server
