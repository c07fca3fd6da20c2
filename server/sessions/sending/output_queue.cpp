#include "sessions/sending/output_queue.hpp"

#include <utility>

namespace meniscus::server {

void OutputQueue::push(SharedMessage message) {
    bool wake = false;
    {
        const std::lock_guard lock(mutex_);
        if (finished_ || closed_) return;
        messages_.push_back(std::move(message));
        wake = std::exchange(consumer_waits_, false);
    }
    if (wake) wake_();
}

void OutputQueue::finish(std::exception_ptr error) {
    end(std::move(error), false);
}

void OutputQueue::abort(std::exception_ptr error) {
    end(std::move(error), true);
}

void OutputQueue::end(std::exception_ptr error, bool drop) {
    bool wake = false;
    {
        const std::lock_guard lock(mutex_);
        if (drop) messages_.clear();
        if (finished_) return;
        finished_ = true;
        aborted_ = drop;
        error_ = std::move(error);
        wake = std::exchange(consumer_waits_, false) || drop;
    }
    changed_.notify_all();
    if (wake) wake_();
}

bool OutputQueue::wait_for_room() {
    std::unique_lock lock(mutex_);
    producer_waits_since_ = Clock::now();
    taken_since_ = 0;
    pace_ = {};
    changed_.wait(lock, [&] { return is_room(); });
    producer_waits_since_.reset();
    return !finished_ && !closed_;
}

bool OutputQueue::has_room() const {
    const std::lock_guard lock(mutex_);
    return is_room();
}

std::optional<OutputQueue::Stall> OutputQueue::too_slow(const LeastPace& least, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (!producer_waits_since_) return std::nullopt;
    const Stall stall{.time = now - *producer_waits_since_, .bytes_taken = taken_since_};
    if (!pace_.too_slow(least, stall.time, stall.bytes_taken)) return std::nullopt;
    return stall;
}

bool OutputQueue::aborted() const {
    const std::lock_guard lock(mutex_);
    return aborted_;
}

OutputQueue::Next OutputQueue::take() {
    const std::lock_guard lock(mutex_);
    if (!messages_.empty()) {
        SharedMessage message = std::move(messages_.front());
        messages_.pop_front();
        taken_since_ += message->size();
        changed_.notify_all();
        return message;
    }
    if (finished_) return End{error_};
    consumer_waits_ = true;
    return Nothing{};
}

void OutputQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        messages_.clear();
    }
    changed_.notify_all();
}

}  // namespace meniscus::server
