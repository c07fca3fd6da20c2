#include "sessions/sending/output_queue.hpp"

#include <algorithm>
#include <utility>

namespace meniscus::server {

void OutputQueue::push(const SharedMessage& message) {
    std::vector<std::size_t> waiting;
    {
        const std::lock_guard lock(mutex_);
        if (finished_ || closed_) return;
        for (Reader& reader : readers_) reader.messages.push_back(message);
        waiting = to_wake();
    }
    wake(waiting);
}

void OutputQueue::push_to(std::size_t reader, SharedMessage message) {
    bool waits = false;
    {
        const std::lock_guard lock(mutex_);
        if (finished_ || closed_) return;
        readers_[reader].messages.push_back(std::move(message));
        waits = std::exchange(readers_[reader].waits, false);
    }
    if (waits) wake_(reader);
}

void OutputQueue::finish(std::exception_ptr error) {
    end(std::move(error), false, false);
}

void OutputQueue::abort(std::exception_ptr error) {
    end(std::move(error), true, true);
}

bool OutputQueue::abort_unless_finished(std::exception_ptr error) {
    return end(std::move(error), true, false);
}

bool OutputQueue::end(std::exception_ptr error, bool drop, bool again) {
    std::vector<std::size_t> waiting;
    {
        const std::lock_guard lock(mutex_);
        if (finished_ && !(again && has_messages())) return false;
        if (drop)
            for (Reader& reader : readers_) reader.messages.clear();
        finished_ = true;
        aborted_ = drop;
        if (!error_) error_ = std::move(error);
        waiting = to_wake(drop);
    }
    changed_.notify_all();
    wake(waiting);
    return true;
}

bool OutputQueue::has_messages() const {
    return std::ranges::any_of(readers_, [](const Reader& reader) { return !reader.messages.empty(); });
}

bool OutputQueue::is_room() const {
    return finished_ || closed_ || std::ranges::all_of(readers_, [](const Reader& reader) {
               return reader.messages.size() <= room_for_a_frame;
           });
}

std::vector<std::size_t> OutputQueue::to_wake(bool all) {
    std::vector<std::size_t> readers;
    for (std::size_t i = 0; i < readers_.size(); ++i)
        if (std::exchange(readers_[i].waits, false) || all) readers.push_back(i);
    return readers;
}

void OutputQueue::wake(const std::vector<std::size_t>& readers) const {
    for (const std::size_t reader : readers) wake_(reader);
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

bool OutputQueue::finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

OutputQueue::Next OutputQueue::take(std::size_t reader) {
    const std::lock_guard lock(mutex_);
    auto& messages = readers_[reader].messages;
    if (!messages.empty()) {
        SharedMessage message = std::move(messages.front());
        messages.pop_front();
        taken_since_ += message->size();
        changed_.notify_all();
        return message;
    }
    if (finished_) return End{error_};
    readers_[reader].waits = true;
    return Nothing{};
}

void OutputQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        for (Reader& reader : readers_) reader.messages.clear();
    }
    changed_.notify_all();
}

}  // namespace meniscus::server
