#include "sessions/latest_frame.hpp"

#include <utility>

namespace meniscus::server {

void LatestFrame::put(std::shared_ptr<const EncodedFrame> frame) {
    bool wake = false;
    {
        const std::lock_guard lock(mutex_);
        if (finished_) return;
        frame_.swap(frame);
        wake = std::exchange(consumer_waits_, false);
    }
    if (wake) wake_();
}

void LatestFrame::finish(std::exception_ptr error) {
    bool wake = false;
    {
        const std::lock_guard lock(mutex_);
        if (finished_) return;
        finished_ = true;
        error_ = std::move(error);
        wake = std::exchange(consumer_waits_, false);
    }
    if (wake) wake_();
}

LatestFrame::Next LatestFrame::take() {
    const std::lock_guard lock(mutex_);
    if (frame_) return std::exchange(frame_, nullptr);
    if (finished_) return End{error_};
    consumer_waits_ = true;
    return Nothing{};
}

}  // namespace meniscus::server
