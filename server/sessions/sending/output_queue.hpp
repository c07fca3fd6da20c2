// Messages on their way to the simulator that uploads: every one, in order.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <variant>

#include "sessions/limits/upload_pace.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Bounded to one frame and a few messages: the producer waits for room before it begins a frame.
class OutputQueue {
public:
    /// Frames begin only while no more than this many messages wait.
    static constexpr std::size_t room_for_a_frame = 8;

    struct Nothing {};  ///< yet: `wake` will be called
    struct End {
        std::exception_ptr error;  ///< none: all went well
    };
    using Next = std::variant<Nothing, SharedMessage, End>;
    using Clock = std::chrono::steady_clock;

    /// The consumer's pace while the producer waits for room.
    struct Stall {
        std::chrono::duration<double> time{};
        std::size_t bytes_taken = 0;
    };

    /// wake: called once, by a producing thread, after take() has found nothing and there is something again; and by
    /// abort().
    explicit OutputQueue(std::function<void()> wake) : wake_(std::move(wake)) {}

    // The producer's side.
    void push(SharedMessage message);
    /// No messages follow. Later calls do nothing.
    void finish(std::exception_ptr error);
    /// Ends the queue as finish() does, and drops the messages that wait.
    void abort(std::exception_ptr error);
    /// Waits until a frame may begin. Returns false if nobody will read it.
    bool wait_for_room();
    /// Whether wait_for_room() would not wait.
    bool has_room() const;
    /// None: the producer does not wait, or what waits is taken fast enough. Ask again and again.
    std::optional<Stall> too_slow(const LeastPace& least, Clock::time_point now);

    // The consumer's side, one thread at a time.
    Next take();
    /// The consumer is gone: nothing is kept any more.
    void close();
    /// Whether its messages were dropped for an error.
    bool aborted() const;

private:
    void end(std::exception_ptr error, bool drop);
    /// With the lock held.
    bool is_room() const { return finished_ || closed_ || messages_.size() <= room_for_a_frame; }

    const std::function<void()> wake_;
    mutable std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::deque<SharedMessage> messages_;
    std::exception_ptr error_;
    std::optional<Clock::time_point> producer_waits_since_;
    std::size_t taken_since_ = 0;  ///< bytes
    PaceCheck pace_;
    bool finished_ = false;
    bool aborted_ = false;
    bool closed_ = false;
    bool consumer_waits_ = false;
};

}  // namespace meniscus::server
