// Threads that take turns, in the order in which they came.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace meniscus::python {

/// In place of a mutex, which a thread that calls again and again would hardly ever leave to another.
class Turns {
public:
    /// A place in the queue, left at the end of its life, whether its turn had come or not.
    class Turn {
    public:
        explicit Turn(Turns& turns);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

        /// Whether this thread has another place before, so that this turn would never come.
        bool is_nested() const;
        /// Returns whether the turn has come.
        bool wait(std::chrono::milliseconds limit);

    private:
        Turns& turns_;
        const std::thread::id thread_ = std::this_thread::get_id();
    };

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<const Turn*> queue_;  ///< the first has its turn
};

}  // namespace meniscus::python
