// Waits for frames no longer than a caller wants to.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "connection/deadline.hpp"
#include "meniscus/client/next.hpp"

namespace meniscus::client {

/// gRPC's blocking calls know no such limit: a wait that may have to be left goes on in a thread. After a frame that
/// was waited for in this way the next one is received ahead, so that a caller that only looks finds every frame at its
/// next look. Callers that wait without a limit have no thread.
///
/// Its owner makes `receive` return, as by canceling the call, before this goes.
template <class Frame>
class LimitedWait {
public:
    /// receive: waits for the next frame; none after the last.
    explicit LimitedWait(std::function<std::optional<Frame>()> receive) : receive_(std::move(receive)) {}

    std::optional<Frame> next() { return ahead_.valid() ? ahead_.get() : receive_(); }

    Next<Frame> next(std::chrono::milliseconds timeout) {
        if (ended_) return {.ended = true};
        if (!ahead_.valid()) begin();
        if (ahead_.wait_until(deadline_after<std::chrono::steady_clock>(timeout)) != std::future_status::ready)
            return {};
        std::optional<Frame> frame = ahead_.get();
        ended_ = !frame.has_value();
        if (ended_) return {.ended = true};
        begin();
        return {.frame = std::move(frame)};
    }

    /// Until `receive` has returned, if it runs.
    void finish() const {
        if (ahead_.valid()) ahead_.wait();
    }

private:
    void begin() { ahead_ = std::async(std::launch::async, receive_); }

    const std::function<std::optional<Frame>()> receive_;
    std::future<std::optional<Frame>> ahead_;
    bool ended_ = false;  ///< the last frame has been waited for
};

}  // namespace meniscus::client
