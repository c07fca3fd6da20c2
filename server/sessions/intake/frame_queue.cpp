#include "sessions/intake/frame_queue.hpp"

#include <algorithm>
#include <utility>

namespace meniscus::server {

namespace {

FrameQueue::Next kind_of(const Received& received) {
    return received.input != nullptr ? FrameQueue::Next::frame : FrameQueue::Next::note;
}

}  // namespace

void FrameQueue::put(Received received) {
    {
        const std::lock_guard lock(mutex_);
        if (closed_) return;
        if (received.watchers && std::ranges::any_of(waiting_, &Received::watchers)) return;
        waiting_.push_back(std::move(received));
    }
    changed_.notify_one();
}

std::vector<InputFrame*> FrameQueue::replace(const Upload& upload) {
    std::vector<InputFrame*> replaced;
    const std::lock_guard lock(mutex_);
    for (Received& received : waiting_) {
        if (received.upload.get() != &upload || received.input == nullptr) continue;
        received.upload->unreported_drops.add();
        received.dropped = DroppedFrame{.index = received.input->index, .reason = DropReason::replaced};
        replaced.push_back(std::exchange(received.input, nullptr));
    }
    return replaced;
}

std::vector<FrameUpload> FrameQueue::sent_ahead(const Upload& upload) {
    std::vector<FrameUpload> sent;
    const std::lock_guard lock(mutex_);
    for (const Received& received : waiting_)
        if (received.upload.get() == &upload && received.input != nullptr) sent.push_back(received.input->sent());
    return sent;
}

std::vector<InputFrame*> FrameQueue::withdraw(const Upload& upload) {
    std::vector<InputFrame*> withdrawn;
    const std::lock_guard lock(mutex_);
    std::erase_if(waiting_, [&](const Received& received) {
        if (received.upload.get() != &upload) return false;
        if (received.input != nullptr) withdrawn.push_back(received.input);
        return received.input != nullptr || received.dropped.has_value();
    });
    return withdrawn;
}

FrameQueue::Next FrameQueue::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
    return closed_ ? Next::closed : kind_of(waiting_.front());
}

std::optional<Received> FrameQueue::take(Next kind) {
    const std::lock_guard lock(mutex_);
    if (closed_ || waiting_.empty() || kind_of(waiting_.front()) != kind) return std::nullopt;
    std::optional<Received> received(std::move(waiting_.front()));
    waiting_.pop_front();
    return received;
}

std::vector<InputFrame*> FrameQueue::close() {
    std::vector<InputFrame*> unused;
    std::deque<Received> forgotten;  // destroyed outside of the lock
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        forgotten.swap(waiting_);
    }
    changed_.notify_all();
    for (const Received& received : forgotten)
        if (received.input != nullptr) unused.push_back(received.input);
    return unused;
}

}  // namespace meniscus::server
