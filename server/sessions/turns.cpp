#include "sessions/turns.hpp"

namespace meniscus::server {

Turns::Turn Turns::wait() {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = asked_++;
    ended_.wait(lock, [&] { return current_ == mine; });
    return Turn(*this);
}

std::uint64_t Turns::waiting() {
    const std::lock_guard lock(mutex_);
    return asked_ > current_ ? asked_ - current_ - 1 : 0;
}

void Turns::end() {
    {
        const std::lock_guard lock(mutex_);
        ++current_;
    }
    ended_.notify_all();
}

}  // namespace meniscus::server
