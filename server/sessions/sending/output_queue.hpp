// Messages on their way to the simulator that uploads: every one, in order, to each of its streams.
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
#include <vector>

#include "sessions/limits/upload_pace.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// Bounded to one frame and a few messages: the producer waits for room before it begins a frame. Each of its readers
/// takes its own messages, and the slowest of them is waited for.
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

    /// wake: called once for a reader, by a producing thread, after its take() has found nothing and there is something
    /// again; and by abort(). readers: at least 1.
    explicit OutputQueue(std::function<void(std::size_t reader)> wake, std::size_t readers = 1)
        : wake_(std::move(wake)), readers_(readers) {}

    // The producer's side.
    void push(const SharedMessage& message);
    /// To one reader alone.
    void push_to(std::size_t reader, SharedMessage message);
    /// No messages follow. Later calls do nothing.
    void finish(std::exception_ptr error);
    /// Drops the messages that wait, and ends the queue with the error. One that has finished ends with it only if it
    /// did so well, and messages wait.
    void abort(std::exception_ptr error);
    /// False, and nothing is dropped, where the queue has finished: what waits is still taken.
    bool abort_unless_finished(std::exception_ptr error);
    /// Waits until a frame may begin. Returns false if nobody will read it.
    bool wait_for_room();
    /// Whether wait_for_room() would not wait.
    bool has_room() const;
    /// None: the producer does not wait, or what waits is taken fast enough. Ask again and again.
    std::optional<Stall> too_slow(const LeastPace& least, Clock::time_point now);

    // The consumers' side, of each reader one thread at a time.
    Next take(std::size_t reader = 0);
    /// The consumers are gone: nothing is kept any more.
    void close();
    /// Whether its messages were dropped for an error.
    bool aborted() const;
    /// Whether no message follows those that wait.
    bool finished() const;

private:
    struct Reader {
        std::deque<SharedMessage> messages;
        bool waits = false;
    };

    /// again: also where it has finished and messages wait. False: nothing was done.
    bool end(std::exception_ptr error, bool drop, bool again);
    // With the lock held.
    bool has_messages() const;
    bool is_room() const;
    /// The readers that wait, or all, to be woken outside of the lock. They wait no longer.
    std::vector<std::size_t> to_wake(bool all = false);
    void wake(const std::vector<std::size_t>& readers) const;

    const std::function<void(std::size_t)> wake_;
    mutable std::mutex mutex_;  ///< for what follows
    std::condition_variable changed_;
    std::vector<Reader> readers_;
    std::exception_ptr error_;
    std::optional<Clock::time_point> producer_waits_since_;
    std::size_t taken_since_ = 0;  ///< bytes
    PaceCheck pace_;
    bool finished_ = false;
    bool aborted_ = false;
    bool closed_ = false;
};

}  // namespace meniscus::server
