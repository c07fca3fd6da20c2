// A process of `meniscus push -`, which speaks gRPC where this library does not: frames go into its standard input, and
// its standard output has the answers.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "pushing/json_line.hpp"

namespace meniscus::pushing {

/// The program: MENISCUS_PROGRAM, or `meniscus` in PATH. what: needs it. Throws NotBuilt where there is none.
std::string push_program(const char* what);

/// write() and finish() belong to one thread, next() to one (other) thread, cancel() to any.
class PushProcess {
public:
    /// token: in its environment; empty: as in this one's. Throws client::ServerError if it cannot be started.
    PushProcess(const std::string& program, const std::vector<std::string>& arguments, const std::string& token);
    /// Ends it.
    ~PushProcess();
    PushProcess(const PushProcess&) = delete;
    PushProcess& operator=(const PushProcess&) = delete;

    /// Waits while it takes no more. Throws what it has said once it has ended; after cancel(): ServerError (canceled).
    void write(std::span<const std::byte> bytes);
    /// No more bytes will come.
    void finish();

    struct Answer {
        std::optional<JsonLine> line;
        bool ended = false;  ///< there are no more
    };
    /// Waits for the next answer, as long as the timeout, or without one for as long as it takes. Throws what it has
    /// said last, if that was an error.
    Answer next(std::optional<std::chrono::milliseconds> timeout);
    /// Frames that its policy has left out so far.
    std::uint64_t dropped() const { return dropped_; }

    /// Ends it, and what waits in other threads.
    void cancel();

private:
    /// On a thread of its own: takes all that it answers, so that it never waits for this process.
    void listen();
    void take(std::string_view line);
    void take_end();
    /// Throws once it has ended.
    [[noreturn]] void fail_ended(std::unique_lock<std::mutex>& lock);

    std::string program_;
    int input_ = -1;  ///< of frames
    int answers_ = -1;
    std::mutex mutex_;
    std::condition_variable changed_;
    pid_t process_ = -1;  ///< -1: it has ended; here and below: under the mutex
    std::deque<JsonLine> lines_;
    bool said_all_ = false;  ///< its last line has come
    bool has_ended_ = false;
    bool is_canceled_ = false;
    std::exception_ptr error_;
    std::atomic<std::uint64_t> dropped_ = 0;
    std::thread listener_;
};

}  // namespace meniscus::pushing
