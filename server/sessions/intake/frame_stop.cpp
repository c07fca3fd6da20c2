#include "sessions/intake/frame_stop.hpp"

namespace meniscus::server {

void FrameStop::cancel(Upload& upload) {
    upload.canceled = true;
    const std::lock_guard lock(mutex_);
    if (upload_ == &upload) stop(Reason::canceled);
}

void FrameStop::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    if (under_way_) stop(Reason::closed);
}

FrameStop::Reason FrameStop::reason() const {
    const std::lock_guard lock(mutex_);
    return reason_;
}

void FrameStop::begin(const Upload* upload) {
    {
        const std::lock_guard lock(mutex_);
        upload_ = upload;
        under_way_ = true;
        reason_ = Reason::none;
        if (flag_) flag_->lower();
        if (upload != nullptr && upload->canceled) stop(Reason::canceled);
        if (closed_) stop(Reason::closed);
    }
    if (longest_.count() == 0) return;
    deadline_ = deadlines_->at(Timer::Clock::now() + longest_, [this] {
        const std::lock_guard lock(mutex_);
        stop(Reason::too_long);
    });
}

void FrameStop::end() {
    if (longest_.count() != 0) deadlines_->remove(deadline_);
    const std::lock_guard lock(mutex_);
    upload_ = nullptr;
    under_way_ = false;
}

void FrameStop::stop(Reason reason) {
    if (reason_ == Reason::none) reason_ = reason;
    if (flag_) flag_->raise();
}

}  // namespace meniscus::server
