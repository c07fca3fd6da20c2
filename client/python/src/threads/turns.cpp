#include "threads/turns.hpp"

#include <algorithm>

namespace meniscus::python {

Turns::Turn::Turn(Turns& turns) : turns_(turns) {
    const std::lock_guard lock(turns_.mutex_);
    turns_.queue_.push_back(this);
}

Turns::Turn::~Turn() {
    const std::lock_guard lock(turns_.mutex_);
    turns_.queue_.erase(std::find(turns_.queue_.begin(), turns_.queue_.end(), this));
    turns_.changed_.notify_all();
}

bool Turns::Turn::is_nested() const {
    const std::lock_guard lock(turns_.mutex_);
    return std::ranges::count(turns_.queue_, thread_, &Turn::thread_) > 1;
}

bool Turns::Turn::wait(std::chrono::milliseconds limit) {
    std::unique_lock lock(turns_.mutex_);
    return turns_.changed_.wait_for(lock, limit, [this] { return turns_.queue_.front() == this; });
}

}  // namespace meniscus::python
