// What a watcher will be sent next: one slot, replaced by newer state.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <variant>

#include "sessions/encoded_frame.hpp"

namespace meniscus::server {

/// A watcher that lags finds the newest whole frame here, never a backlog.
class LatestFrame {
public:
    struct Nothing {};  ///< for now: `wake` will be called
    struct End {
        std::exception_ptr error;  ///< none: all went well
    };
    using Next = std::variant<Nothing, std::shared_ptr<const EncodedFrame>, End>;

    /// wake: called once, by a producing thread, after take() has found nothing and there is something again.
    explicit LatestFrame(std::function<void()> wake) : wake_(std::move(wake)) {}

    /// Replaces a frame that has not been taken.
    void put(std::shared_ptr<const EncodedFrame> frame);
    /// Nothing follows the frame that waits now; the first call counts.
    void finish(std::exception_ptr error);

    Next take();

private:
    const std::function<void()> wake_;
    std::mutex mutex_;
    std::shared_ptr<const EncodedFrame> frame_;
    std::exception_ptr error_;
    bool finished_ = false;
    bool consumer_waits_ = false;
};

}  // namespace meniscus::server
